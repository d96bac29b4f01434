//! A test that drifted: the structure was another one while one reference was struck than while another was.
//!
//! A hammer test takes an hour; temperature and settling change joints and moduli meanwhile. All FRFs of a
//! structure that stays the same share its poles, whatever a model of it leaves out: masses, interfaces and
//! laws move the poles of all FRFs alike, gains, delays and misplaced points move none, and an accelerometer
//! that roves moves those of its own response. Poles that differ between references beyond what responses
//! explain are therefore drift (or a structure that depends on amplitude, struck differently), and no
//! physics.
//!
//! 1. **Quick test** ([`poles_by_frf`]). Each reference's FRFs are fitted freely by themselves; ln ω of the
//!    modes that several references show are compared.
//! 2. **FRF by FRF** ([`poles_by_frf`]). Where they differ, each FRF's own poles are taken; what differs by
//!    response is no drift ([`table`]).
//! 3. **Little drift** ([`levelled`]). Where natural frequencies differ by no more than some kelvins make them,
//!    each mode of each reference is put where it lies on the mean of all, and the diagnosis goes on with all
//!    FRFs.
//! 4. **Agreeing references** ([`agreement`]). Else it goes on with those of the most references whose poles
//!    agree.
//! 5. **What drifted** ([`attribution`]). Each stiffness moves each mode by its share of the strain energy, d
//!    ln ω/d ln k = s/2. The shares of the model that the diagnosis ends with tell which stiffness explains
//!    the differences, and by how much.

mod agreement;
mod attribution;
mod drifted;
mod levelled;
mod poles_by_frf;
mod table;

pub use attribution::{ModeDrift, ReferenceChange, TestDrift};
pub(crate) use drifted::Drifted;
pub(crate) use poles_by_frf::distinct;
