//! Prints what a universal file holds, for other programs to compare:
//! `cargo run -p jointscope-uff --example dump -- FILE [--values OUT] [--beside] [--time REPEATS]`
//!
//! One line of tab-separated header fields a function on standard output; `--values` puts abscissa and
//! ordinates of all functions into a file of little-endian doubles (complex ones as real, imaginary);
//! `--beside` prints geometry and shapes instead; `--time` prints the best time of reading alone, in seconds.

use std::error::Error;
use std::time::Instant;

use jointscope_uff::{Data, Dataset58, UffFile, ValueLocation, read};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str| {
        arguments.iter().position(|argument| argument == name).and_then(|at| arguments.get(at + 1))
    };
    let bytes = std::fs::read(
        arguments.first().ok_or("usage: dump FILE [--values OUT] [--beside] [--time REPEATS]")?,
    )?;
    if let Some(repeats) = option("--time") {
        let mut best = f64::INFINITY;
        for _ in 0..repeats.parse::<usize>()? {
            let start = Instant::now();
            let file = read(&bytes)?;
            best = best.min(start.elapsed().as_secs_f64());
            std::hint::black_box(file);
        }
        println!("{best}");
        return Ok(());
    }
    let file = read(&bytes)?;
    if arguments.iter().any(|argument| argument == "--beside") {
        beside(&file);
        return Ok(());
    }
    for function in &file.datasets {
        println!("{}", header(function));
    }
    if let Some(path) = option("--values") {
        let mut out = Vec::new();
        for function in &file.datasets {
            values(function, |value| out.extend_from_slice(&value.to_le_bytes()));
        }
        std::fs::write(path, out)?;
    }
    Ok(())
}

/// Geometry and shapes, a line each.
fn beside(file: &UffFile) {
    let numbers = |numbers: &[i64]| numbers.iter().map(i64::to_string).collect::<Vec<_>>().join(" ");
    for node in file.nodes.iter().flat_map(|nodes| &nodes.nodes) {
        let [x, y, z] = node.coordinates;
        println!("node {} {} {x:e} {y:e} {z:e}", node.label, node.displacement_system);
    }
    for system in &file.systems {
        let values: Vec<String> =
            system.axes.iter().flatten().chain(&system.origin).map(|v| format!("{v:e}")).collect();
        println!("system {} {}", system.label, values.join(" "));
    }
    for element in &file.elements {
        println!("element {} {} {}", element.label, element.descriptor, numbers(&element.nodes));
    }
    for trace in &file.traces {
        println!("trace {} {}", trace.number, numbers(&trace.nodes));
    }
    for data in file.nodal.iter().filter(|data| data.location == ValueLocation::Nodes) {
        let frequency = data.frequency.unwrap_or(0.0);
        println!("data {} {} {} {frequency:e}", data.dataset, data.mode, data.values.len());
        for at in &data.values {
            let values: Vec<String> = at.values.iter().map(|v| format!("{:e} {:e}", v.re, v.im)).collect();
            println!("values {} {}", at.node, values.join(" "));
        }
    }
}

fn header(function: &Dataset58) -> String {
    let complex = matches!(function.data, Data::Complex(_));
    [
        function.function.code().to_string(),
        function.sequence_number.to_string(),
        function.response.number.to_string(),
        function.response.direction.to_string(),
        function.reference.number.to_string(),
        function.reference.direction.to_string(),
        function.abscissa_axis.data_type.to_string(),
        function.ordinate_axis.data_type.to_string(),
        function.denominator_axis.data_type.to_string(),
        function.ordinate_axis.units.clone(),
        function.id_lines[0].clone(),
        function.id_lines[3].clone(),
        function.id_lines[4].clone(),
        function.data.len().to_string(),
        u8::from(complex).to_string(),
    ]
    .join("\t")
}

fn values(function: &Dataset58, mut emit: impl FnMut(f64)) {
    (0..function.abscissa.len()).for_each(|point| emit(function.abscissa.value(point)));
    match &function.data {
        Data::Real(values) => values.iter().for_each(|&value| emit(value)),
        Data::Complex(values) => values.iter().for_each(|value| {
            emit(value.re);
            emit(value.im);
        }),
    }
}
