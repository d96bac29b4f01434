//! Numbers of a sensor that loads the structure where it is.

/// Difference in ln ω within which poles that two parts of a recording lead to are one of the model.
pub(crate) const SAME_POLE: f64 = 1e-5;
/// Where the search for a pole sets out from beside that of the structure without the sensor, relative.
pub(crate) const BESIDE_POLE: f64 = -1e-5;
/// Largest mass, as a multiple of the largest from which a search by lines sets out.
pub(crate) const MOST: f64 = 5.0;
/// Steps to the mass, each of which takes what it does to the modes for proportional to it: three digits more
/// with each for masses of some per cent of a body.
pub(crate) const STEPS: usize = 4;
/// Rounds in which factors of responses and means of modes follow each other: both stand still long before.
pub(crate) const FACTOR_ROUNDS: usize = 40;
/// Standard deviation of a natural frequency from one record to the next whatever its noise, relative: a tenth
/// of a kelvin moves one of steel by as much.
pub(crate) const REPEATS: f64 = 2e-5;
/// Standard deviation of what a mass does to a mode, relative: squares of shapes at the sensor are known to
/// a few per cent where the model is a little wrong.
pub(crate) const SHAPES: f64 = 0.05;
/// Relative deviation up to which a stated sensor's mass is taken as it is: what it is off by moves natural
/// frequencies a tenth as much as the sensor does.
pub(crate) const STATED_WELL: f64 = 0.1;
/// Share of χ² that stated sensors may leave.
pub(crate) const STATED_LEFT: f64 = 0.5;
/// What χ² must lose for it: 5 standard deviations.
pub(crate) const GAINED: f64 = 25.0;
/// Share of χ² that may be left where that is more than noise. A free fit to few lines errs by more than its
/// noise; what a sensor makes of all modes it leaves all the same.
pub(crate) const EXPLAINED: f64 = 0.1;
/// Weights beside the best place: of anything that is not listed, and of a change from response to response
/// that all frequencies share, as temperature makes it.
pub(crate) const OTHERWISE: [f64; 2] = [0.03, 0.25];
