//! What a search weighs by, with the reason or the measurement behind each number.
//!
//! "Measured" means: by `jointscope prove` on 200 to 500 concealed cases (`docs/records`), where a value was
//! varied by about a factor of two each way and the one kept that lost no score; times are processor time.
//!
//! What a caller may set are the fields of [`Settings`] and of what it holds, with their defaults at the end
//! of this file ([`ModalSettings`] and [`LocationSettings`] have theirs beside them). What no caller sets are
//! constants, by the question that they decide:
//!
//! | module | numbers of |
//! |---|---|
//! | [`lines`] | what is taken from a recording: FRFs and lines that are searched, their noise, lines that contradict all others |
//! | [`drift`] | structures that change between references |
//! | [`effects`] | where a search for effects sets out, how far their parameters may go, how common they are; quantities that are stated wrongly |
//! | [`location`] | the map of places with no law assumed |
//! | [`modal`] | fits to modes: priors, descents and their rounds, sizes of a model's error, walks along a ridge |
//! | [`evidence`] | probabilities, and what counts as explained |
//! | [`moved_sensor`] | a sensor that loads the structure where it is |
//! | [`statements`] | what is said of a diagnosis: from when on a difference is worth a word |
//! | [`work`] | what things cost, and what share of the work one step may take |
//!
//! Limits of rounding and halvings of an interval, which decide nothing, stand where they are used; so do
//! physical constants, sizes of arrays and the starts that belong to a law.

pub(crate) mod drift;
pub(crate) mod effects;
pub(crate) mod evidence;
pub(crate) mod lines;
pub(crate) mod location;
pub(crate) mod modal;
pub(crate) mod moved_sensor;
pub(crate) mod statements;
pub(crate) mod work;

use jointscope_inference::{Limit, StepDamping};
use jointscope_model_error::ErrorSizes;
pub use location::{LawSettings, LocationSettings};

/// How a diagnosis searches.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Settings {
    /// Fits of a hypothesis to the FRFs.
    pub fit: FitSettings,
    /// Which candidates are fitted, and how far.
    pub ranking: RankingSettings,
    /// When an effect is believed, and when a search ends.
    pub selection: SelectionSettings,
    /// Probabilities and verdict.
    pub evidence: EvidenceSettings,
    /// The comparison by modes.
    pub modal: ModalSettings,
    /// The map of places with no law assumed.
    pub location: LocationSettings,
    /// Predicted values of FRFs after which a search ends with what it has, a model counted as a thousand
    /// besides: about half a minute on one core. A case of four FRFs on 400 lines takes 5 to 50 million.
    pub work: u64,
}

/// Fits of a hypothesis to the FRFs.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FitSettings {
    /// Steps of one stage with inflated noise, and of the last stage.
    pub steps: (usize, usize),
    /// Damping of the steps. An effect and a quantity that do almost the same need nearly undamped ones.
    pub damping: StepDamping,
    /// Decrease of the objective below which a fit has converged: a hundredth of what one parameter gains by
    /// chance.
    pub converged: f64,
    /// The same as a share of what a poor fit leaves beyond the degrees of freedom: such fits are compared
    /// across large differences.
    pub negligible: f64,
    /// Convergence of a stage with inflated noise, as a share of its objective: it only has to find the way.
    pub inflated: f64,
    /// The same where many such fits are compared.
    pub inflated_among_many: f64,
    /// Derivatives are taken anew when a step gains less than this share of their first one's gain. They cost
    /// as much as several predictions.
    pub reuse: f64,
    /// How often an undamped step is tried along a flat valley.
    pub valleys: usize,
    /// Share of what an undamped step promises below which a fit follows a curved valley.
    pub curved_valley: f64,
    /// When a fit that competes with others is given up; its objective is the competition's. Small effects
    /// are found along flat valleys, a little at a time: within `reach` no fit is too slow.
    pub limit: Limit,
    /// Noise inflation of the stages on thinned lines, then of the one on all lines. 1 is as far as a
    /// resonance may be from its place.
    pub inflation: ([f64; 4], f64),
    /// Lines of a thinned fit: enough for the course of the FRFs between resonances.
    pub thinned_lines: usize,
    /// χ² per degree of freedom above which a refit tries other starts too, and how many of these it follows
    /// to the end.
    pub other_starts: (f64, usize),
    /// Relative deviation from which on a quantity counts as widely known, so that its resonances may lie
    /// anywhere between others.
    pub wide: f64,
    /// Shares of its size by which an effect fades when it is dropped.
    pub fading: [f64; 4],
    /// Step of differences in units of a coordinate: small against a resonance's width, large against
    /// rounding.
    pub difference: f64,
    /// Relative change of an FRF that a difference may make at any line where uncertainties are stated, and
    /// the least share of `difference`: collinear parameters need accurate derivatives, or the prior does not
    /// decide between them.
    pub small_difference: (f64, f64),
}

/// Which candidates are fitted, and how far.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RankingSettings {
    /// Candidates of the local search that are refined, and starts of each.
    pub local: (usize, usize),
    /// Candidates that are refined beside what modes are sure of.
    pub few: usize,
    /// Candidates of the global search that are kept after the stages on thinned lines, and those of them
    /// kept from two starts.
    pub thinned: (usize, usize),
    /// The same after the stage on all lines.
    pub whole: (usize, usize),
    /// Fits that leave more than this many times the best one's objective are dropped, after each stage: one
    /// in a false minimum may still win, the likelier the more the noise is inflated.
    pub dropped: [f64; 4],
    /// The stage at which starts join to which a thinned fit without the candidate has led.
    pub joins: usize,
    /// χ² per degree of freedom above which the best single effect leaves so much that several starts of each
    /// candidate are tried, and how many.
    pub several: (f64, usize),
    /// χ² of one deviation, noise inflated, below which a quantity stays where it is in a thinned fit.
    pub insensitive: f64,
    /// Noise inflation at which starts are scored.
    pub scored: f64,
    /// Fits made without a limit before the others are measured against the best of them.
    pub unlimited: usize,
    /// A fit whose objective will stay this far above the best is not finished: e⁻³⁰ as probable.
    pub margin: f64,
    /// Decrease of χ² by an effect below which quantities make up for nearly all of it, so that its
    /// look-alikes are near where they do…
    pub small: f64,
    /// … and the distance from the limit within which their fits go on whatever derivatives promise: from
    /// there they hardly creep. What came below the limit in chains of 8 and 12 bodies without it did so with
    /// it.
    pub small_reach: f64,
}

/// When an effect is believed, and when a search ends.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SelectionSettings {
    /// What any effect must gain in χ², beyond its parameters and 2 ln(candidates): measured, no false
    /// finding in 50 nulls.
    pub penalty: f64,
    /// What each of its parameters must gain besides: a χ² of one, and its prior's width.
    pub parameter_penalty: f64,
    /// What it must gain over what leaves no more than noise as it is, none of its quantities far off.
    pub beside_noise: f64,
    /// Standard deviations of χ² up to which nothing large is left to be found, without and with effects.
    pub fits: (f64, f64),
    /// Standard deviations of Σ(deviation/std)² up to which quantities are deviated by chance. A layer of
    /// glue once hid behind 12 deviations of one modulus.
    pub deviated: f64,
    /// How many of the quantities that a refit took farthest from what is stated compete with effects as
    /// wrong ones.
    pub wrong: usize,
    /// Penalties that an effect must be worth, faded by a quarter, to be kept without a further fit.
    pub clear: f64,
    /// Share of all work for a search among the names that modes hold most probable where none of them
    /// explains the modes (two effects in lumped structures took a tenth, one a twentieth), and its effects
    /// at the most: three at once imitate almost anything.
    pub among_few: (f64, usize),
    /// Rounds of adding and dropping.
    pub rounds: usize,
    /// Effects at the most: a fourth beside three would fit almost anything.
    pub effects: usize,
    /// Rounds of exchanging each of several effects.
    pub exchanges: usize,
}

/// The comparison by modes, with the model's own error.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ModalSettings {
    /// Sizes of a model's error that are usual.
    pub usual: ErrorSizes,
    /// Sizes of what changes from one recording to the next of a structure that stays as it is, where its
    /// clamp and its cables do not. Of a real clamped beam, natural frequencies scatter by 0.1 to 0.2 % over
    /// 70 recordings, damping ratios by a tenth and more. Shapes and mass lines are taken as half of what models
    /// are wrong by, and phases to repeat no better than sizes; what lies above the band as all of it: a free
    /// fit writes what a record's end leaves into it, and two of blocks that nothing had changed were 20 % apart.
    pub repeated: ErrorSizes,
    /// The usual error of natural frequencies where no body turns: storeys that tilt on columns which
    /// lengthen, and columns that swing with their mass, leave those of solid frames 0.5 to 2 % from those of
    /// a shear building (docs/development/checks/solids_with_calculix.py, `--frames`).
    pub frequency_of_storeys: f64,
    /// The usual error of upper residuals where all bodies are beams, which have their own modes above the
    /// band: what rigid blocks lack there, these have.
    pub above_of_beams: f64,
    /// Candidates that are fitted alone, and beside others.
    pub refined: (usize, usize),
    /// Starts of each that is fitted alone, and of the best of them (as many as are `tried`) where none
    /// explains the modes so.
    pub starts: (usize, usize),
    /// Starts that are fitted in any case because they have a partner for a recorded mode that had none.
    pub partnering: usize,
    /// Most probable names that are fitted from the quantities of others too, how many of these, and ln p
    /// below the best up to which.
    pub exchanged: (usize, usize, f64),
    /// How often a fit goes on that came to the end of its start's reach.
    pub farther: usize,
    /// Starts that are fitted in any case. Of the others one is fitted if its density lies no more than this
    /// below the best of those, in ln p, or if that best needs unusual errors: a fit seldom gains so much
    /// over its start, and e⁻¹⁵⁰ is no probability.
    pub foremost: (usize, f64),
    /// Share of all work done from which on starts are left out so.
    pub costly: f64,
    /// Share of all work up to which the best names are fitted once more, from further starts: lines want the
    /// rest.
    pub again: f64,
    /// Singles that are tried with a second effect, at the most, and ln p below the best from which they are
    /// not, nor as look-alikes on lines.
    pub bases: (usize, f64),
    /// The most probable singles that are tried two by two: ten pairs. A stiffer joint beside a window was
    /// second and third, 46 and 80 below the relaxation that imitates both.
    pub two_by_two: usize,
    /// Share of all work by which the comparison ends: modes may be in a false minimum, and lines must come
    /// to their turn. With 0.5 three blocks on two strips, of whose masses nothing was stated, had it spent
    /// before two effects together were tried.
    pub share: f64,
    /// Names that are tried on lines, to see whether one of them leaves no more than noise.
    pub tried: usize,
    /// Names that are tried where the recording without what is held out is searched, of the most probable of
    /// the whole, down to `no_rival_within` below the best.
    pub blind: usize,
    /// Effects at the most.
    pub effects: usize,
    /// Odds that an effect must gain beyond those of one among all candidates, and by themselves where lines
    /// ask for it.
    pub odds: f64,
    /// The same beyond what errors and departures refute that chance does not make: the odds are against
    /// those already.
    pub odds_over_refuted: f64,
    /// How often the best effects are exchanged for what explains more beside the others.
    pub exchanges: usize,
    /// Objective per degree of freedom that may be left without an effect that imitates an error of the
    /// model: about three times the noise.
    pub slight: f64,
    /// Standard deviations that the size of an effect must be from nothing, the model's errors as large as
    /// they may well be.
    pub least: f64,
    /// Gain in ln p of each effect over nothing that needs no such question. A fixture that ended in a false
    /// minimum has been 70 short.
    pub undoubted: f64,
    /// ln p below the best at which a name is no longer listed: probability below 0.03 %.
    pub listed: f64,
    /// Sizes of errors as multiples of what is usual, and departures of quantities in standard deviations, up
    /// to which a fit is adequate. Six half-normal sizes exceed the first in one structure of four; with
    /// 2.64, which one of twenty exceeds, three effects in 97 lumped structures were taken for such errors.
    pub adequate: (f64, f64),
    /// Share of the squared errors that the fixture by itself needs, and of what it leaves of the lines as it
    /// predicts them, that is left at the most where something explains them in part.
    pub part: f64,
    /// Share of what the fixture by itself leaves of the lines, squared, that an explanation leaves at the
    /// most where modes do not tell the whole recording. Where they do, 43 explanations of solids left 0.4 %
    /// in the median, and three more than this.
    pub most_left_where_incomplete: f64,
    /// Times by which lines may miss more with what explains the modes than without, squared for χ². Of 86
    /// explanations of solids one missed 1.5 times as much, and was right; a hammer that struck beside the
    /// sensor at its point was taken for gains with which lines missed 94 times as much.
    pub spoils: f64,
    /// Gain in ln p by errors of the model up to which a recording shows none. Measured: 0 to 1 for what is
    /// hidden in lumped structures, 10 and more in solids.
    pub exact: f64,
    /// χ² per degree of freedom of a free fit of modes from which it does not reach the noise.
    pub free_fit_limit: f64,
    /// χ² per degree of freedom of a free fit from which no poles explain the recording: names say nothing
    /// then.
    pub hopeless: f64,
    /// Share of the FRFs up to which what no poles explain in a recording counts as its noise where nothing
    /// else explains it: leakage, filters and strikes beside the point leave some tenths of a per cent to a
    /// per cent that no model of a structure has.
    pub beside_modes: f64,
    /// ln of the weight of physics that no candidate covers, against one for the best: usually, and at the
    /// most, however badly it fits.
    pub unlisted: (f64, f64),
    /// What each effect beside the first adds to that: pairs of effects can imitate much.
    pub company: f64,
    /// ln p below the best at which a name is not tried on lines, and by which names must stand above nothing
    /// where a free fit took all its terms: e⁻⁵⁰ as probable.
    pub no_rival_within: f64,
    /// Starts that compare other modes than their base, at the most, beside the best of each candidate.
    pub apart: usize,
    /// Multiple of the usual sizes by which starts are scored that compare other modes than their base.
    pub wide: f64,
    /// Standard deviation, in coordinates, within which a start's own parameters count as linear when it is
    /// scored.
    pub near: f64,
    /// Shares of the most probable errors of natural frequency and damping that models which are to predict
    /// may have: the first that leaves quantities within chance, or the last. An error of a natural
    /// frequency, divided by the damping ratio, is the error of an FRF beside the resonance: to count no more
    /// than those of shapes it has to be about a hundred times smaller.
    pub followed: [f64; 3],
}

impl Default for ModalSettings {
    fn default() -> Self {
        ModalSettings {
            usual: ErrorSizes::default(),
            repeated: ErrorSizes {
                frequency: 0.0015,
                damping: 0.1,
                shape: 0.0025,
                quadrature: 0.0025,
                mass_line: 0.0005,
                upper_residual: 0.15,
                ..ErrorSizes::default()
            },
            frequency_of_storeys: 0.01,
            above_of_beams: 0.02,
            refined: (20, 6),
            starts: (2, 8),
            partnering: 4,
            exchanged: (4, 2, 30.0),
            farther: 4,
            foremost: (8, 150.0),
            costly: 0.05,
            again: 0.075,
            bases: (3, 20.0),
            two_by_two: 5,
            share: 0.6,
            tried: 8,
            blind: 8,
            effects: 3,
            odds: 100.0,
            odds_over_refuted: 10.0,
            exchanges: 2,
            slight: 10.0,
            least: 3.0,
            undoubted: 200.0,
            listed: 8.0,
            adequate: (2.0, 4.0),
            part: 0.5,
            most_left_where_incomplete: 0.1,
            spoils: 1.6,
            exact: 5.0,
            free_fit_limit: 1.3,
            hopeless: 100.0,
            beside_modes: 0.02,
            unlisted: (-3.5, -0.7),
            company: 1.6,
            no_rival_within: 50.0,
            apart: 24,
            wide: 5.0,
            near: 0.7,
            followed: [0.01, 0.03, 0.1],
        }
    }
}

/// Probabilities and verdict.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct EvidenceSettings {
    /// Hypotheses whose cost is farther than this from the best one's are not listed: probability below
    /// 0.03 %.
    pub listed: f64,
    /// Cost, above the best hypothesis', of physics that none covers: 3 % where the fit is good. Measured:
    /// calibrated to 0.97.
    pub unlisted: f64,
    /// Reduction of that cost for each additional effect: pairs of effects can imitate much.
    pub company: f64,
    /// Probability that a finding and its look-alikes must have together to be stated.
    pub stated: f64,
    /// Odds ratio required to replace a finding: two that cannot be told apart stay as they are.
    pub replace: f64,
    /// Replacements at the most, one less for each effect.
    pub replacements: usize,
    /// χ² per degree of freedom above which a model leaves something unexplained, with variances from
    /// coherence (known to a few per cent) and from scatter (known to a fifth).
    pub explained: (f64, f64),
    /// What a name must gain in χ² where FRFs were estimated from hits and the fixture explains them without:
    /// gains of a channel of 5 % gained 120 to 730 so, in 42 sound structures nothing gained anything.
    pub little_of_estimates: f64,
    /// Probability by chance below which a mismatch is located.
    pub located: f64,
    /// Bands by which a mismatch is stated.
    pub bands: usize,
    /// Share of the lines in each of the two bands held out.
    pub held_out: f64,
}

impl Settings {
    /// The same for FRFs that were estimated from hits: those of one reference share the noise of its force,
    /// which passes for a second effect that gains little.
    pub(crate) fn of_estimates(&self) -> Self {
        let mut settings = self.clone();
        settings.selection.beside_noise = settings.evidence.little_of_estimates;
        settings
    }
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            fit: FitSettings {
                steps: (12, 60),
                damping: StepDamping { initial: 1e-8, decrease: 0.1, least: 1e-13, raised: 0.0, most: 1e7 },
                converged: 0.01,
                negligible: 1e-5,
                inflated: 0.01,
                inflated_among_many: 0.03,
                reuse: 0.15,
                valleys: 3,
                curved_valley: 0.1,
                limit: Limit {
                    objective: f64::INFINITY,
                    promises: 3.0,
                    gains: 5.0,
                    patience: 2,
                    reach: 60.0,
                },
                inflation: ([1.0, 0.3, 0.1, 0.03], 0.01),
                thinned_lines: 100,
                other_starts: (1.3, 3),
                wide: 0.1,
                fading: [0.75, 0.5, 0.25, 0.1],
                difference: 2e-4,
                small_difference: (1e-3, 1e-3),
            },
            ranking: RankingSettings {
                local: (12, 2),
                few: 4,
                thinned: (16, 6),
                whole: (10, 3),
                dropped: [12.0, 10.0, 4.0, 3.0],
                joins: 2,
                several: (1.3, 3),
                insensitive: 8.0,
                scored: 0.1,
                unlimited: 4,
                margin: 60.0,
                small: 60.0,
                small_reach: 4.0,
            },
            selection: SelectionSettings {
                penalty: 8.0,
                parameter_penalty: 3.0,
                beside_noise: 0.0,
                fits: (0.7, 2.0),
                deviated: 8.0,
                wrong: 3,
                clear: 2.0,
                among_few: (0.05, 2),
                rounds: 5,
                effects: 3,
                exchanges: 2,
            },
            evidence: EvidenceSettings {
                listed: 16.0,
                unlisted: 7.0,
                company: 3.2,
                stated: 0.5,
                replace: 1.5,
                replacements: 4,
                explained: (1.2, 1.6),
                little_of_estimates: 60.0,
                located: 0.01,
                bands: 12,
                held_out: 0.06,
            },
            modal: ModalSettings::default(),
            location: LocationSettings::default(),
            work: 600_000_000,
        }
    }
}
