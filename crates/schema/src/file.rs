//! What stands in a fixture file, as a description: nothing is read by these types.
#![allow(dead_code)] // fields are read by the derive alone

use crate::effects::Effect;
use crate::quantity::{NotNegative, PoissonRatio, Positive, Quantity, Ratio};
use schemars::JsonSchema;
use std::collections::BTreeMap;

/// What is believed about an assembly of bodies and joints. SI units; x runs from the first body to the last, y is transverse, θ is positive from x to y.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(crate) struct FixtureFile {
    /// Where an editor finds this schema.
    #[schemars(rename = "$schema")]
    schema: Option<String>,
    /// The assembly's name, for pages and messages.
    name: Option<String>,
    /// Remarks for readers of the file, one text or several; the model knows nothing of them.
    notes: Option<Notes>,
    /// Bodies by name: rigid blocks, storeys that do not rotate, or beams.
    #[schemars(extend("minProperties" = 1))]
    bodies: BTreeMap<String, Body>,
    /// Places where something is struck, measured or joined, by the node numbers of the recordings.
    points: BTreeMap<String, Point>,
    /// Joints between two points of different bodies, by name.
    #[schemars(default)]
    joints: BTreeMap<String, Joint>,
    /// Damping of bodies and joints; supports have their own.
    damping: Option<Damping>,
    /// Springs and dashpots to ground, by name.
    #[schemars(default)]
    supports: BTreeMap<String, Support>,
    /// Effects beyond the plain model.
    #[schemars(default)]
    physics: Vec<Effect>,
    /// How well the measuring chain is known, by channel: `response N`, `reference N`, `force`, `record N/M` for the record of one FRF, or `*` for every FRF's record by itself. What is not stated is exact.
    channels: Option<Channels>,
    /// Relative standard deviations of what such a model gets wrong in every mode, where they are known.
    model_error: Option<ModelError>,
    /// The assembly as a solid, for the finite-element twin.
    geometry: Option<Geometry>,
}

/// One text or several.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Notes {
    One(String),
    Several(Vec<String>),
}

/// A body: rigid, rigid without rotation (a storey), or a beam.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Body {
    Rigid(Rigid),
    Storey(Storey),
    Beam(BeamBody),
}

/// A rigid block that moves along y and turns by θ.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Rigid {
    /// kg. A bare number is known to 0.2 %.
    mass: Positive,
    /// Moment of inertia about its centre of gravity, kg·m². A bare number is known to 1 %.
    inertia: Positive,
    /// Abscissa of its centre of gravity, m. A bare number is known to 0.2 mm.
    x_cg: Quantity,
    #[schemars(default, extend("const" = true))]
    rotates: bool,
    /// Known rigid point masses on it.
    #[schemars(default)]
    masses: Vec<PointMass>,
}

/// A storey of a frame: it moves along y alone.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Storey {
    /// kg. A bare number is known to 0.2 %.
    mass: Positive,
    /// `false`: a rigid body without rotation.
    #[schemars(extend("const" = false))]
    rotates: bool,
    /// Not needed, kg·m².
    inertia: Option<Positive>,
    /// Not needed, m.
    x_cg: Option<Quantity>,
    /// Known rigid point masses on it.
    #[schemars(default)]
    masses: Vec<PointMass>,
}

/// A deformable body: an Euler–Bernoulli beam.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct BeamBody {
    beam: Beam,
    /// Known rigid point masses on it.
    #[schemars(default)]
    masses: Vec<PointMass>,
}

/// A uniform beam between two abscissae.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Beam {
    /// Abscissa of its left end, m. A bare number is known to 0.2 mm.
    from: Quantity,
    /// Abscissa of its right end, m. A bare number is known to 0.2 mm.
    to: Quantity,
    /// Pa; steel 2.07e11. A bare number is known to 2 %.
    youngs_modulus: Positive,
    /// m⁴; b·h³/12 of a rectangle of height h along y. A bare number is known to 1 %.
    second_moment: Positive,
    /// kg/m; density times area. A bare number is known to 1 %.
    mass_per_length: Positive,
}

/// A known rigid point mass: a sensor, a bolt.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct PointMass {
    /// Abscissa, m. A bare number is known to 0.2 mm.
    x: Quantity,
    /// kg. A bare number is known to 0.2 %.
    mass: NotNegative,
}

/// A place on a body.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Point {
    /// The name of the body it is on.
    body: String,
    /// Abscissa, m. A bare number is known to 0.2 mm.
    x: Quantity,
}

/// A joint: a massless beam between its points, or a stiffness matrix.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Joint {
    Beam(BeamJoint),
    Stiffness(StiffnessJoint),
}

/// A massless Euler–Bernoulli beam, as long as its points are apart.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct BeamJoint {
    /// The point it starts from, the one of smaller x.
    from: String,
    /// The point it leads to.
    to: String,
    beam: JointBeam,
}

/// The beam of a joint.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct JointBeam {
    /// Pa; steel 2.07e11. A bare number is known to 2 %.
    youngs_modulus: Positive,
    /// m⁴; b·h³/12 of a rectangle of height h along y. A bare number is known to 1 %.
    second_moment: Positive,
}

/// A stiffness on d = u_to − R·u_from, u = (y, θ), R = [[1, L], [0, 1]].
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct StiffnessJoint {
    /// The point it starts from.
    from: String,
    /// The point it leads to.
    to: String,
    /// [[k11, k12], [k21, k22]] in N/m, N/rad, N·m/rad, symmetric. Bare numbers are known to 5 %.
    stiffness: [[Quantity; 2]; 2],
    /// [[c11, c12], [c21, c22]] in N·s/m, N·s/rad, N·m·s/rad, symmetric. Bare numbers are known to 30 %.
    damping: Option<[[Quantity; 2]; 2]>,
}

/// Damping, by one of three laws.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Damping {
    Ratios(ModalRatios),
    Rayleigh(RayleighDamping),
    LossFactor(LossFactor),
    None(Undamped),
}

/// Ratios of the elastic modes.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct ModalRatios {
    /// Damping ratios of the elastic modes in ascending frequency; 1 % is 0.01, modes beyond the list take the last. Bare numbers are known to 30 %.
    modal_ratios: Vec<Ratio>,
    /// Of which assembly: as it stands, supports included (where nothing is said), or `free`: of bodies and joints alone.
    of: Option<RatiosOf>,
}

#[derive(JsonSchema)]
enum RatiosOf {
    #[schemars(rename = "free")]
    Free,
    #[schemars(rename = "as it stands")]
    AsItStands,
}

/// C = mass·M + stiffness·K.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct RayleighDamping {
    rayleigh: Rayleigh,
}

/// Factors of mass and stiffness.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Rayleigh {
    /// 1/s; 0 where nothing is said. A bare number is known to 30 %.
    mass: Option<NotNegative>,
    /// s; 0 where nothing is said. A bare number is known to 30 %.
    stiffness: Option<NotNegative>,
}

/// K·(1 + iη).
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct LossFactor {
    /// η of bodies and joints, a pure number. A bare number is known to 30 %.
    loss_factor: NotNegative,
}

/// None stated.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Undamped {}

/// A spring and dashpot to ground, at a point or anywhere on a body.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Support {
    AtPoint(SupportAtPoint),
    OnBody(SupportOnBody),
}

/// A support at a point.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct SupportAtPoint {
    /// The name of the point.
    point: String,
    /// N/m. A bare number is known to 20 %.
    stiffness: NotNegative,
    /// N·s/m. A bare number is known to 30 %.
    damping: Option<NotNegative>,
    /// Against rotation, N·m/rad. A bare number is known to 20 %. A clamp is a support with both.
    rotational_stiffness: Option<NotNegative>,
    /// N·m·s/rad. A bare number is known to 30 %.
    rotational_damping: Option<NotNegative>,
}

/// A support anywhere on a body.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct SupportOnBody {
    /// The name of the body.
    body: String,
    /// Abscissa, m. A bare number is known to 0.2 mm.
    x: Quantity,
    /// N/m. A bare number is known to 20 %.
    stiffness: NotNegative,
    /// N·s/m. A bare number is known to 30 %.
    damping: Option<NotNegative>,
    /// Against rotation, N·m/rad. A bare number is known to 20 %. A clamp is a support with both.
    rotational_stiffness: Option<NotNegative>,
    /// N·m·s/rad. A bare number is known to 30 %.
    rotational_damping: Option<NotNegative>,
}

/// How well the measuring chain is known.
#[derive(JsonSchema)]
#[schemars(extend("propertyNames" = { "pattern": "^(response .+|reference .+|record .+/.+|force|[*])$" }))]
struct Channels {
    /// Every FRF's record by itself.
    #[schemars(rename = "*")]
    records: Option<RecordGain>,
    /// The channels by their names.
    #[schemars(flatten)]
    channels: BTreeMap<String, Channel>,
}

/// The gain of every FRF's record by itself, as of a roving hammer.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct RecordGain {
    /// {"value": 1, "std": 0.1}: its value is 1, its deviation is below 1.
    gain: Positive,
}

/// How well a channel is known.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Channel {
    /// Factor on the signal, with its deviation: {"value": 1, "std": 0.05}.
    gain: Option<Quantity>,
    /// Delay against the other channels, s: {"value": 0, "std": 1e-6}.
    delay: Option<Quantity>,
}

/// Relative standard deviations, each between 0 and 1, or 0 of all three where the model is exact; what is not stated is estimated from the recording.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct ModelError {
    /// Of natural frequencies; 0.3 % is 0.003.
    #[schemars(extend("minimum" = 0, "exclusiveMaximum" = 1))]
    frequency: Option<f64>,
    /// Of damping ratios.
    #[schemars(extend("minimum" = 0, "exclusiveMaximum" = 1))]
    damping: Option<f64>,
    /// Of residues, that is of shapes.
    #[schemars(extend("minimum" = 0, "exclusiveMaximum" = 1))]
    residue: Option<f64>,
}

/// Every body a box, every joint a strip between two of them; all of them, or none.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Geometry {
    /// Materials by name.
    materials: BTreeMap<String, Material>,
    /// A box for each body.
    bodies: BTreeMap<String, BodySolid>,
    /// A strip for each joint.
    #[schemars(default)]
    joints: BTreeMap<String, JointSolid>,
    /// Heights of points, where that is not the upper face of their body.
    #[schemars(default)]
    points: BTreeMap<String, PointHeight>,
}

/// An isotropic elastic material.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Material {
    /// Pa.
    youngs_modulus: Positive,
    /// A pure number between −1 and 0.5.
    poisson_ratio: PoissonRatio,
    /// kg/m³.
    density: Positive,
}

/// A body as a box.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct BodySolid {
    /// Abscissa of its left face, m.
    from: Quantity,
    /// Abscissa of its right face, m.
    to: Quantity,
    /// Extent along y, m.
    height: Positive,
    /// Extent along z, m.
    depth: Positive,
    /// Height of its centre, m; 0 where nothing is said.
    y: Option<Quantity>,
    /// The name of its material.
    material: String,
}

/// A joint as a strip, with a layer of weld or glue at either end.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct JointSolid {
    /// Extent along y, m.
    thickness: Positive,
    /// Extent along z, m.
    width: Positive,
    /// Height of its centre, m; 0 where nothing is said.
    y: Option<Quantity>,
    /// The name of its material.
    material: String,
    /// Layers by the point of the joint's end.
    #[schemars(default)]
    interfaces: BTreeMap<String, Layer>,
}

/// A layer of weld or glue, of the strip's cross-section.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Layer {
    /// Extent along x, m.
    thickness: Positive,
    /// The name of its material.
    material: String,
}

/// The height of a point.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct PointHeight {
    /// m.
    y: Quantity,
}
