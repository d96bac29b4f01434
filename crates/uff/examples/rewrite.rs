//! Writes the functions of a universal file again in another form:
//! `cargo run -p jointscope-uff --example rewrite -- IN OUT ascii|little|big|same single|double|same`

use std::error::Error;

use jointscope_uff::{ByteOrder, Encoding, Precision, read, write};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output, encoding, precision] = arguments.as_slice() else {
        return Err("usage: rewrite IN OUT ascii|little|big|same single|double|same".into());
    };
    let mut functions = read(&std::fs::read(input)?)?.datasets;
    for function in &mut functions {
        function.encoding = match encoding.as_str() {
            "ascii" => Encoding::Ascii,
            "little" | "binary" => Encoding::Binary(ByteOrder::Little),
            "big" => Encoding::Binary(ByteOrder::Big),
            _ => function.encoding,
        };
        function.precision = match precision.as_str() {
            "single" => Precision::Single,
            "double" => Precision::Double,
            _ => function.precision,
        };
    }
    std::fs::write(output, write(&functions)?)?;
    Ok(())
}
