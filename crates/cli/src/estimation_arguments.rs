//! How FRFs are made of hammer hits, as the command line says it.

use clap::Args;
use jointscope::Measurement;
use jointscope::estimation::{Baseline, EstimateOptions, Estimator, ForceWindow, ResponseWindow, Weighting};

use crate::values::{one_of, positive};

/// Options of every command that reads time histories.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Hammer hits (time histories)")]
pub(crate) struct EstimationArguments {
    /// How FRFs follow from the spectra: H1 (noise on the responses), H2 (noise on the force), Hv (between
    /// them).
    #[arg(long, value_parser = one_of(&ESTIMATORS), default_value = "H1", ignore_case = true)]
    pub estimator: Estimator,
    /// How hits count in an average: `auto` inversely to their noise where it differs, `plain` as the
    /// textbook says.
    #[arg(long, value_parser = one_of(&WEIGHTS), default_value = "auto")]
    pub weights: Weighting,
    /// What is taken off every signal: its offset, a straight line, or nothing.
    #[arg(long, value_parser = one_of(&BASELINES), default_value = "offset")]
    pub detrend: Baseline,
    /// Keep the force for so many seconds after its onset, then fade it out; `auto` for ten widths of the
    /// pulse [default: none].
    #[arg(long, value_name = "SECONDS", value_parser = force_window)]
    pub force_window: Option<ForceWindow>,
    /// Exponential window of this decay over force and responses; `auto` where a record ends too early,
    /// `none`.
    #[arg(long, value_name = "1/S", value_parser = response_window)]
    pub response_window: Option<ResponseWindow>,
    /// Fill records with zeros to so many times their length.
    #[arg(long, value_name = "TIMES", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub zero_padding: u32,
    /// Hits to use whatever is wrong with them, by number.
    #[arg(long, value_name = "HIT", num_args = 1.., value_delimiter = ',')]
    pub keep: Vec<u32>,
    /// Hits to leave out, by number.
    #[arg(long, value_name = "HIT", num_args = 1.., value_delimiter = ',')]
    pub reject: Vec<u32>,
}

const ESTIMATORS: [(&str, Estimator); 3] =
    [("H1", Estimator::H1), ("H2", Estimator::H2), ("Hv", Estimator::Hv)];
const WEIGHTS: [(&str, Weighting); 2] = [("auto", Weighting::Auto), ("plain", Weighting::Plain)];
const BASELINES: [(&str, Baseline); 3] =
    [("offset", Baseline::Offset), ("drift", Baseline::Drift), ("keep", Baseline::Keep)];

impl EstimationArguments {
    /// The arguments as options of FRFs that a model is held against.
    pub(crate) fn for_models(&self) -> EstimateOptions {
        let EstimateOptions { response_window, unbiased, .. } = EstimateOptions::for_models();
        EstimateOptions { unbiased, ..self.options(response_window) }
    }

    /// The arguments as options of the textbook's estimate, `response_window` where they state none.
    pub(crate) fn options(&self, response_window: ResponseWindow) -> EstimateOptions {
        EstimateOptions {
            estimator: self.estimator,
            weighting: self.weights,
            baseline: self.detrend,
            force_window: self.force_window.unwrap_or_default(),
            response_window: self.response_window.unwrap_or(response_window),
            zero_padding: self.zero_padding,
            unbiased: false,
            keep: self.keep.clone(),
            reject: self.reject.clone(),
        }
    }

    /// The note that they were given with FRFs, which need no estimate.
    pub(crate) fn unused_with(&self, measurement: &Measurement) -> Option<String> {
        let default = EstimateOptions { zero_padding: 1, ..EstimateOptions::default() };
        let given = self.response_window.is_some() || self.options(ResponseWindow::None) != default;
        (given && matches!(measurement, Measurement::Frfs(_)))
            .then(|| "the files hold FRFs: options for hammer hits do not apply".to_owned())
    }
}

fn force_window(text: &str) -> Result<ForceWindow, String> {
    match text {
        "auto" => Ok(ForceWindow::Auto),
        "none" => Ok(ForceWindow::None),
        _ => positive(text).map(ForceWindow::Length).ok_or_else(|| {
            "seconds after the hit's onset, `auto` or `none` are needed, such as 0.01".to_owned()
        }),
    }
}

fn response_window(text: &str) -> Result<ResponseWindow, String> {
    match text {
        "auto" => Ok(ResponseWindow::Auto),
        "none" => Ok(ResponseWindow::None),
        _ => positive(text)
            .map(ResponseWindow::Decay)
            .ok_or_else(|| "a decay in 1/s, `auto` or `none` is needed, such as 12.5".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Estimating {
        #[command(flatten)]
        estimation: EstimationArguments,
    }

    fn parse(words: &[&str]) -> Result<EstimateOptions, String> {
        Estimating::try_parse_from(["estimating"].iter().chain(words))
            .map(|parsed| parsed.estimation.options(ResponseWindow::None))
            .map_err(|error| error.to_string())
    }

    #[test]
    fn the_defaults_are_the_textbooks() {
        let expected = EstimateOptions { zero_padding: 1, ..EstimateOptions::default() };
        assert_eq!(parse(&[]), Ok(expected));
    }

    #[test]
    fn windows_are_numbers_or_auto_and_hits_are_lists() {
        let options = parse(&[
            "--force-window",
            "0.01",
            "--response-window",
            "auto",
            "--keep",
            "3,5",
            "--reject",
            "4",
            "7",
        ]);
        let options = options.unwrap();
        assert_eq!(options.force_window, ForceWindow::Length(0.01));
        assert_eq!(options.response_window, ResponseWindow::Auto);
        assert_eq!((options.keep, options.reject), (vec![3, 5], vec![4, 7]));
        assert_eq!(parse(&["--estimator", "h2"]).unwrap().estimator, Estimator::H2);
        assert!(parse(&["--response-window", "-3"]).is_err());
        assert!(parse(&["--response-window=-3"]).unwrap_err().contains("12.5"));
        assert!(parse(&["--force-window", "0"]).unwrap_err().contains("0.01"));
        assert!(parse(&["--zero-padding", "0"]).is_err());
    }
}
