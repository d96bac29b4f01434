//! The command line: commands, their arguments, and how those are spelled.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use jointscope::Band;
use jointscope_recordings::{AssumedUnits, ChannelMap, ChannelMapError, ReadOptions};
use jointscope_spectra::{Channel, Dof, FrfPair, SpectralLines};

use crate::estimation_arguments::EstimationArguments;
use crate::refusal::Refusal;

/// Stiffness and damping of a joint from hammer tests on the blocks it connects.
#[derive(Debug, Parser)]
#[command(name = "jointscope", version, max_term_width = 110)]
pub struct Program {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// FRFs of an assembly, computed from its fixture file, its effects included.
    Synthesize(SynthesizeArguments),
    /// FRFs with coherence from hammer hits: time histories of force and responses.
    Estimate(EstimateArguments),
    /// Stiffness and damping of a joint by frequency, from the FRFs of the assembly: stiffness.json and report.html.
    Decompose(DecomposeArguments),
    /// What physics the fixture leaves out, where it sits and how sure that is: diagnosis.json, refitted.json, repaired.json, report.html.
    Diagnose(DiagnoseArguments),
    /// Several decompositions side by side, and which joint is the stiffer: comparison.json and report.html.
    Compare(crate::compare::CompareArguments),
    /// FRFs of the fixture's finite-element twin, the assembly as a deformable solid.
    Fem(crate::fem::FemArguments),
    /// Natural frequencies, damping ratios and mode shapes from FRFs, with their standard deviations: modes.json and report.html.
    Modes(ModesArguments),
    /// Accelerations of an assembly over time under recorded forces, effects that depend on amplitude included.
    Simulate(SimulateArguments),
    /// How often the diagnosis is right: concealed cases of a simulated laboratory, and a table of scores.
    Prove(crate::prove::ProveArguments),
    /// The paper's Tables 1–6, its values beside the program's.
    Tables(crate::tables::TablesArguments),
}

#[derive(Debug, Args)]
pub struct SynthesizeArguments {
    /// The fixture file (JSON).
    pub fixture: PathBuf,
    /// FRFs to compute, response over reference, such as 4/1 or 4:theta/1 [default: 4/1 3/1 4/2 3/2].
    #[arg(long, value_name = "OUT/IN", value_parser = frf_pair, num_args = 1..)]
    pub frf: Vec<FrfPair>,
    /// Spectral lines in Hz: first, last and step.
    #[arg(long, value_name = "FROM:TO:STEP", value_parser = spectral_lines, default_value = "2.5:1000:2.5")]
    pub lines: SpectralLines,
    /// As a perfect instrument would read them, without the effects of sensors and analyser.
    #[arg(long)]
    pub perfect: bool,
    /// Write text (dataset 58) instead of binary (58b).
    #[arg(long)]
    pub ascii: bool,
    /// The universal file to write.
    #[arg(short, long, value_name = "F.uff")]
    pub output: PathBuf,
}

#[derive(Debug, Args)]
pub struct SimulateArguments {
    /// The fixture file (JSON).
    pub fixture: PathBuf,
    /// The forces (UFF time histories, ordinate type 13), one for each hit.
    #[arg(long, value_name = "F.uff")]
    pub force: PathBuf,
    /// Where to read accelerations, such as 3 4:theta [default: transverse at every point].
    #[arg(long, value_name = "POINT", value_parser = one_channel, num_args = 1..)]
    pub at: Vec<Channel>,
    /// Write the forces too, so that the file is a whole recording.
    #[arg(long)]
    pub with_force: bool,
    /// Write text (dataset 58) instead of binary (58b).
    #[arg(long)]
    pub ascii: bool,
    /// The universal file to write.
    #[arg(short, long, value_name = "R.uff")]
    pub output: PathBuf,
}

#[derive(Debug, Args)]
pub struct EstimateArguments {
    #[command(flatten)]
    pub recording: RecordingArguments,
    /// Write text (dataset 58) instead of binary (58b).
    #[arg(long)]
    pub ascii: bool,
    /// The universal file to write.
    #[arg(short, long, value_name = "F.uff")]
    pub output: PathBuf,
    #[command(flatten)]
    pub estimation: EstimationArguments,
}

#[derive(Debug, Args)]
pub struct DecomposeArguments {
    /// The fixture file (JSON).
    pub fixture: PathBuf,
    #[command(flatten)]
    pub recording: RecordingArguments,
    /// The joint to find; needed where the fixture has several.
    #[arg(long, value_name = "J")]
    pub joint: Option<String>,
    /// Band of the averages and of the fit in Hz [default: the quietest band, and all lines].
    #[arg(long, value_name = "F1:F2", value_parser = band)]
    pub band: Option<Band>,
    /// How K and C follow from the FRFs: `exact`, or eq (7) of the `paper` without the transport across the joint.
    #[arg(long, value_enum, default_value_t = RelationName::Exact)]
    pub relation: RelationName,
    /// Take numbers of the fixture without a standard deviation as exact.
    #[arg(long)]
    pub exact: bool,
    /// The directory to write to.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    #[command(flatten)]
    pub estimation: EstimationArguments,
}

#[derive(Debug, Args)]
pub struct DiagnoseArguments {
    /// The fixture file (JSON).
    pub fixture: PathBuf,
    #[command(flatten)]
    pub recording: RecordingArguments,
    /// The band to use, in Hz [default: all lines].
    #[arg(long, value_name = "F1:F2", value_parser = band)]
    pub band: Option<Band>,
    /// Bands to leave out, in Hz, such as mains hum.
    #[arg(long, value_name = "F1:F2", value_parser = band, num_args = 1..)]
    pub exclude: Vec<Band>,
    /// FRFs to judge by, which no fit sees [default: one, where there are four or more].
    #[arg(long, value_name = "OUT/IN", value_parser = frf_pair, num_args = 1..)]
    pub hold_out: Vec<FrfPair>,
    /// Take numbers of the fixture without a standard deviation as exact.
    #[arg(long)]
    pub exact: bool,
    /// Print diagnosis.json to standard output, for scripts.
    #[arg(long)]
    pub json: bool,
    /// The directory to write to; may be left out with --json.
    #[arg(short, long, value_name = "DIR", required_unless_present = "json")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub estimation: EstimationArguments,
}

#[derive(Debug, Args)]
pub struct ModesArguments {
    #[command(flatten)]
    pub recording: RecordingArguments,
    /// The band to use, in Hz [default: all lines].
    #[arg(long, value_name = "F1:F2", value_parser = band)]
    pub band: Option<Band>,
    /// Orders of the stabilisation chart: the highest, or the lowest and the highest.
    #[arg(long, value_name = "N1:N2", value_parser = orders)]
    pub orders: Option<(usize, usize)>,
    /// Frequencies in Hz of the poles to take from the chart, in place of the automatic selection.
    #[arg(long, value_name = "HZ", value_parser = picked, num_args = 1..)]
    pub pick: Vec<f64>,
    /// A fixture file (JSON) whose points the channels are; its elastic modes are matched with the measured ones.
    #[arg(long, value_name = "FIXTURE")]
    pub fixture: Option<PathBuf>,
    /// Write the fixture with the measured damping ratios to this file.
    #[arg(long, value_name = "OUT.json", requires = "fixture")]
    pub update: Option<PathBuf>,
    /// Print modes.json to standard output, for scripts.
    #[arg(long)]
    pub json: bool,
    /// The directory to write to; may be left out with --json.
    #[arg(short, long, value_name = "DIR", required_unless_present = "json")]
    pub output: Option<PathBuf>,
}

/// The relations by their names on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum RelationName {
    Exact,
    Paper,
}

/// Recordings and what the analyst says of them, for every command that reads FRFs or time histories.
#[derive(Debug, Args)]
pub struct RecordingArguments {
    /// The recordings (UFF, UNV): all files of one test, in any order.
    #[arg(required = true, value_name = "F.uff")]
    pub files: Vec<PathBuf>,
    /// Which channel of the files is which of the fixture, such as 101:+z=1:+y.
    #[arg(long, value_name = "NODE:DIR=POINT:DIR", value_parser = map_entry, num_args = 1..)]
    pub map: Vec<String>,
    /// Units of response and force where a file states none, such as g,lbf.
    #[arg(long, value_name = "RESPONSE,FORCE", value_parser = AssumedUnits::parse)]
    pub assume_units: Option<AssumedUnits>,
}

impl RecordingArguments {
    /// The arguments as options of the reading.
    pub fn options(&self) -> Result<ReadOptions, Refusal> {
        let map = ChannelMap::parse(&self.map).map_err(Refusal::new)?;
        Ok(ReadOptions { map, assume_units: self.assume_units.clone() })
    }
}

/// Reads `F1:F2` in Hz.
pub fn band(text: &str) -> Result<Band, String> {
    let form = "two frequencies in Hz are needed, the lower first, such as 200:800";
    let (from, to) = text.split_once(':').ok_or(form)?;
    match (frequency(from), frequency(to)) {
        (Some(from), Some(to)) if from < to => Ok(Band { from, to }),
        _ => Err(form.to_owned()),
    }
}

/// Reads `N` or `N1:N2`.
fn orders(text: &str) -> Result<(usize, usize), String> {
    let number = |text: &str| text.trim().parse().ok().filter(|n: &usize| *n > 0);
    let ends = match text.split_once(':') {
        None => number(text).map(|to| (to.min(2), to)),
        Some((from, to)) => number(from).zip(number(to)),
    };
    ends.filter(|(from, to)| from <= to).ok_or_else(|| {
        "whole numbers above zero are needed, the highest order or both ends, such as 40 or 4:40".to_owned()
    })
}

/// A frequency in Hz above zero.
fn picked(text: &str) -> Result<f64, String> {
    frequency(text).filter(|hz| *hz > 0.0).ok_or_else(|| "a frequency in Hz above zero is needed".to_owned())
}

/// More lines than any analyser makes: a slip in the step.
const MOST_LINES: f64 = 1e7;

/// Reads `FROM:TO:STEP` in Hz; the last line is the last step not beyond TO.
pub fn spectral_lines(text: &str) -> Result<SpectralLines, String> {
    let form = "first line, last line and step in Hz are needed, such as 2.5:1000:2.5";
    let mut fields = text.split(':');
    let (Some(from), Some(to), Some(step), None) =
        (fields.next(), fields.next(), fields.next(), fields.next())
    else {
        return Err(form.to_owned());
    };
    let (Some(from), Some(to), Some(step)) = (frequency(from), frequency(to), frequency(step)) else {
        return Err(form.to_owned());
    };
    if to < from {
        return Err(format!("the last line, {to} Hz, lies below the first, {from} Hz"));
    }
    if step == 0.0 {
        return Err("the step must be above 0 Hz".to_owned());
    }
    // 1000 Hz is the 400th of 2.5 Hz steps however the quotient rounds.
    let steps = ((to - from) / step * (1.0 + 1e-12) + 1e-9).floor();
    if steps >= MOST_LINES {
        return Err(format!("these are {} lines; take a larger step", steps + 1.0));
    }
    SpectralLines::even(from, step, steps as usize + 1).map_err(|error| error.to_string())
}

/// A finite number of Hz, zero or above.
fn frequency(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|hz: &f64| hz.is_finite() && *hz >= 0.0)
}

/// Reads `OUT/IN`: channels `4`, `4:y` or `4:theta`.
pub fn frf_pair(text: &str) -> Result<FrfPair, String> {
    let form = || "response over reference is needed, such as 4/1 or 4:theta/1".to_owned();
    let (response, reference) = text.split_once('/').ok_or_else(form)?;
    match (channel(response)?, channel(reference)?) {
        (Some(response), Some(reference)) => Ok(FrfPair::new(response, reference)),
        _ => Err(form()),
    }
}

/// Reads a channel: `4`, `4:y` or `4:theta`.
fn one_channel(text: &str) -> Result<Channel, String> {
    channel(text)?.ok_or_else(|| "a point is needed, such as 4 or 4:theta".to_owned())
}

/// `None` where the point has no name or more than one slash follows.
fn channel(text: &str) -> Result<Option<Channel>, String> {
    let (point, dof) = match text.trim().rsplit_once(':') {
        None => (text.trim(), Dof::Translation),
        Some((point, "y")) => (point, Dof::Translation),
        Some((point, "theta")) => (point, Dof::Rotation),
        Some((_, other)) => return Err(format!("`{other}` is neither `y` nor `theta`")),
    };
    let named = !point.is_empty() && !point.contains('/');
    Ok(named.then(|| Channel { point: point.to_owned(), dof }))
}

/// One map entry, checked by itself; entries are checked against each other in [`RecordingArguments::options`].
pub fn map_entry(text: &str) -> Result<String, ChannelMapError> {
    ChannelMap::parse([text]).map(|_| text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Program::command().debug_assert();
    }

    #[test]
    fn lines_run_from_the_first_to_the_last_in_steps() {
        let lines = |text| spectral_lines(text).map(|lines| (lines.len(), lines.hz()[lines.len() - 1]));
        assert_eq!(lines("2.5:1000:2.5"), Ok((400, 1000.0)));
        assert_eq!(lines("0:1:0.1").unwrap().0, 11);
        assert_eq!(lines("10:12:1.5"), Ok((2, 11.5)));
        assert_eq!(lines("5:5:1"), Ok((1, 5.0)));
        for (bad, part) in [
            ("1:2", "such as"),
            ("1:2:3:4", "such as"),
            ("a:2:1", "such as"),
            ("-1:2:1", "such as"),
            ("1:inf:1", "such as"),
            ("2:1:1", "lies below"),
            ("1:2:0", "above 0 Hz"),
            ("0:1e9:1e-3", "larger step"),
        ] {
            let message = spectral_lines(bad).unwrap_err();
            assert!(message.contains(part), "{bad}: {message}");
        }
    }

    #[test]
    fn a_band_has_two_ends_the_lower_first() {
        assert_eq!(band("200:800"), Ok(Band { from: 200.0, to: 800.0 }));
        for bad in ["200", "800:200", "200:200", "a:b", "1:2:3", "-5:2", "nan:2"] {
            assert!(band(bad).unwrap_err().contains("such as 200:800"), "{bad}");
        }
    }

    #[test]
    fn orders_are_the_highest_or_both_ends() {
        assert_eq!(orders("40"), Ok((2, 40)));
        assert_eq!(orders("1"), Ok((1, 1)));
        assert_eq!(orders("4:40"), Ok((4, 40)));
        for bad in ["0", "a", "5:4", "0:4", "-3", "4:"] {
            assert!(orders(bad).unwrap_err().contains("such as 40 or 4:40"), "{bad}");
        }
        assert!(picked("0").is_err() && picked("nan").is_err() && picked("112.5") == Ok(112.5));
    }

    #[test]
    fn an_frf_is_response_over_reference() {
        assert_eq!(frf_pair("4/1"), Ok(FrfPair::transverse("4", "1")));
        let theta = FrfPair::new(Channel::rotational("4"), Channel::transverse("a:b"));
        assert_eq!(frf_pair("4:theta/a:b:y"), Ok(theta));
        for bad in ["4", "4/", "/1", "4/1/2", ""] {
            assert!(frf_pair(bad).unwrap_err().contains("4:theta/1"), "{bad}");
        }
        assert!(frf_pair("4:x/1").unwrap_err().contains("`x`"));
    }

    #[test]
    fn recordings_come_with_their_map_and_units() {
        #[derive(Debug, Parser)]
        struct Reading {
            #[command(flatten)]
            recording: RecordingArguments,
        }
        let parse = |words: &[&str]| Reading::try_parse_from(["reading"].iter().chain(words));
        let reading =
            parse(&["a.uff", "b.uff", "--map", "101:z=1:y", "102:z=2:y", "--assume-units", "g,lbf"]);
        let recording = reading.unwrap().recording;
        assert_eq!(recording.files.len(), 2);
        let options = recording.options().unwrap();
        assert_eq!(options.map.entries().len(), 2);
        assert!(options.assume_units.is_some());
        assert!(parse(&[]).is_err());
        assert!(parse(&["a.uff", "--map", "101=1"]).unwrap_err().to_string().contains("101:+z=1:+y"));
        assert!(parse(&["a.uff", "--assume-units", "g"]).unwrap_err().to_string().contains("`g,lbf`"));
        let twice = parse(&["a.uff", "--map", "1:z=1:y", "--map", "1:-z=2:y"]).unwrap();
        assert!(twice.recording.options().unwrap_err().to_string().contains("same channel"));
    }
}
