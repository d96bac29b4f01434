//! What one unknown scalar at a site does to every FRF on a line.

use super::Site;
use jointscope_fixture::{Dof, Entry, Fixture, Place, Side};
use jointscope_lumped::{
    Instrument, JointElement, MeasuringChain, Model, Receptances, Station, channel_station, nominal_stiffness,
};
use jointscope_spectra::{Channel, FrfPair};
use num_complex::Complex64;

/// One FRF's recorded value as the site's scalar z grows: h + (z a + z² b)/(1 + z t + z² d).
///
/// One channel through the structure is linear in z = γ (t appears where a sensor's own mass makes bᵀZ⁻¹b
/// differ from row to row), a position that is response and reference at once is a square, a factor on a
/// joint's 2×2 stiffness is the whole expression.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RationalResponse {
    pub start: Complex64,
    pub linear: Complex64,
    pub square: Complex64,
    pub lower_linear: Complex64,
    pub lower_square: Complex64,
}

impl RationalResponse {
    /// The value at z.
    pub(super) fn at(&self, z: Complex64) -> Complex64 {
        if self.is_linear() {
            return self.start + z * self.linear;
        }
        let upper = z * (self.linear + z * self.square);
        let lower = 1.0 + z * (self.lower_linear + z * self.lower_square);
        self.start + upper / lower
    }

    /// The value at z and its derivative there.
    pub(super) fn with_slope(&self, z: Complex64) -> (Complex64, Complex64) {
        if self.is_linear() {
            return (self.start + z * self.linear, self.linear);
        }
        let upper = z * (self.linear + z * self.square);
        let inverse = (1.0 + z * (self.lower_linear + z * self.lower_square)).inv();
        let share = upper * inverse;
        let upper_slope = self.linear + 2.0 * z * self.square;
        let lower_slope = self.lower_linear + 2.0 * z * self.lower_square;
        (self.start + share, (upper_slope - share * lower_slope) * inverse)
    }

    /// Whether z enters linearly.
    pub(super) fn is_linear(&self) -> bool {
        let zero = Complex64::ZERO;
        self.square == zero && self.lower_linear == zero && self.lower_square == zero
    }
}

/// How the scalar z of a line becomes the missing component: sign·z/(1 − feedback·z), which for what is in
/// series is its compliance 1/δ, and else δ.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inversion {
    pub sign: f64,
    pub feedback: Complex64,
    /// Receptance of a response's own position, for what a mass there would do.
    pub driving: Complex64,
}

impl Inversion {
    /// The component of z.
    pub(super) fn delta(&self, z: Complex64) -> Complex64 {
        self.sign * z / (1.0 - self.feedback * z)
    }

    /// z of the component.
    pub(super) fn scalar(&self, delta: Complex64) -> Complex64 {
        delta / (self.sign + self.feedback * delta)
    }

    /// The derivative of z with respect to the component.
    pub(super) fn scalar_slope(&self, delta: Complex64) -> Complex64 {
        let lower = self.sign + self.feedback * delta;
        self.sign / (lower * lower)
    }
}

/// Stations that a site acts through, at the most.
const MOST: usize = 4;

/// How the site's stations become FRFs.
enum Action {
    /// b = a combination of stations, the same on all lines: a body at an abscissa.
    Body,
    /// b = a column of a joint's dynamic stiffness: a compliance at one of its ends.
    Series { element: JointElement, end: usize },
    /// A factor on a joint's elastic stiffness `[k11, k12, k22]`, of this length.
    Joint { stiffness: [f64; 3], length: f64 },
    /// Rows (or columns) of the FRFs named here: multiplied by 1 + δ, or divided by it.
    Channel { rows: Vec<bool>, divides: bool, driving: Option<usize> },
    /// FRFs whose response, and whose reference, sits there.
    Position { responses: Vec<bool>, references: Vec<bool> },
}

/// Receptances wanted, each pair once whichever way round: the structure is reciprocal.
#[derive(Default)]
struct Wanted {
    stations: Vec<Station>,
    pairs: Vec<(usize, usize)>,
}

impl Wanted {
    fn index(&mut self, a: Station, b: Station) -> usize {
        let mut of = |station: Station| {
            self.stations.iter().position(|s| *s == station).unwrap_or_else(|| {
                self.stations.push(station);
                self.stations.len() - 1
            })
        };
        let (a, b) = (of(a), of(b));
        let pair = (a.min(b), a.max(b));
        self.pairs.iter().position(|p| *p == pair).unwrap_or_else(|| {
            self.pairs.push(pair);
            self.pairs.len() - 1
        })
    }
}

/// Indices of one FRF's receptances among the wanted ones.
struct Indices {
    whole: usize,
    from_sites: [usize; MOST],
    to_sites: [usize; MOST],
    load: Option<LoadIndices>,
}

struct LoadIndices {
    mass: f64,
    driving: usize,
    to_response: usize,
    from_reference: usize,
    to_sites: [usize; MOST],
}

/// Receptances of one FRF: between its channels, from the site's stations to its response, and from its
/// reference to them.
struct Local {
    whole: Complex64,
    out: [Complex64; MOST],
    into: [Complex64; MOST],
}

/// Receptances among the site's stations.
type Among = [[Complex64; MOST]; MOST];

/// A site's pattern on a model, evaluated line by line without allocation.
pub(super) struct Pattern<'a> {
    chain: MeasuringChain,
    action: Action,
    count: usize,
    indices: Vec<Indices>,
    among: [[usize; MOST]; MOST],
    receptances: Receptances<'a>,
    values: Vec<Complex64>,
}

impl<'a> Pattern<'a> {
    /// Prepares the pattern of `site` for the FRFs `pairs` on `model`, which is that of `fixture`. `None`
    /// where the site does not exist there, or is not of the form that this file knows.
    pub(super) fn new(fixture: &Fixture, model: &'a Model, site: &Site, pairs: &[FrfPair]) -> Option<Self> {
        let chain = MeasuringChain::of(fixture, pairs, Instrument::AsRecorded).ok()?;
        let mut wanted = Wanted::default();
        let (stations, mut action) = action(fixture, site, pairs)?;
        let first = *stations.first().unwrap_or(&chain.readings.first()?.output);
        let slot = |v: usize| stations.get(v).copied().unwrap_or(first);
        let indices = chain.readings.iter().map(|reading| Indices {
            whole: wanted.index(reading.output, reading.input),
            from_sites: std::array::from_fn(|v| wanted.index(reading.output, slot(v))),
            to_sites: std::array::from_fn(|v| wanted.index(slot(v), reading.input)),
            load: reading.load.map(|(position, mass)| LoadIndices {
                mass,
                driving: wanted.index(position, position),
                to_response: wanted.index(reading.output, position),
                from_reference: wanted.index(position, reading.input),
                to_sites: std::array::from_fn(|v| wanted.index(position, slot(v))),
            }),
        });
        let indices: Vec<Indices> = indices.collect();
        let among = std::array::from_fn(|v| std::array::from_fn(|w| wanted.index(slot(v), slot(w))));
        if let Action::Channel { rows, divides: false, driving } = &mut action {
            let row = rows.iter().position(|r| *r)?;
            let position = chain.readings[row].output;
            *driving =
                (pairs[row].response.dof == Dof::Translation).then(|| wanted.index(position, position));
        }
        let count = stations.len();
        let receptances = model.receptances_of(&wanted.stations, &wanted.stations, wanted.pairs);
        let values = vec![Complex64::ZERO; receptances.count()];
        Some(Pattern { chain, action, count, indices, among, receptances, values })
    }

    /// Writes every FRF's response on the line at `omega` (rad/s); `None` on an undamped resonance.
    pub(super) fn at(&mut self, omega: f64, responses: &mut [RationalResponse]) -> Option<Inversion> {
        let s = self.chain.s(omega);
        if !self.receptances.at(s, &mut self.values) {
            return None;
        }
        let mut own = Among::default();
        for v in 0..self.count {
            for w in 0..self.count {
                own[v][w] = self.values[self.among[v][w]];
            }
        }
        let column = match &self.action {
            Action::Series { element, end } => element.column(s, *end),
            _ => [Complex64::ONE; MOST],
        };
        let along = |g: &[Complex64; MOST]| -> Complex64 { (0..self.count).map(|v| column[v] * g[v]).sum() };
        let quadratic =
            |among: &Among| -> Complex64 { (0..self.count).map(|v| column[v] * along(&among[v])).sum() };
        let driving = quadratic(&own);
        let mut scratch = own;
        for (k, response) in responses.iter_mut().enumerate() {
            let mut local = self.local(k);
            let loaded = self.loaded(k, s, &mut local, &own, &mut scratch);
            let among = if loaded { &scratch } else { &own };
            let factor = self.chain.factor(k, omega);
            *response = RationalResponse { start: factor * local.whole, ..RationalResponse::default() };
            match &self.action {
                Action::Body | Action::Series { .. } => {
                    response.linear = -factor * along(&local.out) * along(&local.into);
                    if loaded {
                        response.lower_linear = quadratic(among) - driving;
                    }
                }
                Action::Joint { stiffness, length } => {
                    joint(response, &local, among, factor, *stiffness, *length);
                }
                Action::Channel { rows, .. } if rows[k] => response.linear = response.start,
                Action::Channel { .. } => {}
                Action::Position { responses, references } => {
                    if responses[k] {
                        response.linear += factor * local.into[0];
                    }
                    if references[k] {
                        response.linear += factor * local.out[0];
                    }
                    if responses[k] && references[k] {
                        response.square = factor * among[0][0];
                    }
                }
            }
        }
        Some(self.inversion(s, driving, &column))
    }

    /// How the scalar of a line becomes the missing component, where the site answers by `driving`.
    fn inversion(&self, s: Complex64, driving: Complex64, column: &[Complex64; MOST]) -> Inversion {
        let plain = Inversion { sign: 1.0, feedback: Complex64::ZERO, driving: Complex64::ZERO };
        match &self.action {
            Action::Body => Inversion { feedback: driving, ..plain },
            // −1/(1/c + rᵀkr) acts through b = Dᵀkr: what is sought is c.
            Action::Series { end, .. } => Inversion { sign: -1.0, feedback: driving - column[*end], ..plain },
            Action::Channel { divides: true, .. } => {
                Inversion { sign: -1.0, feedback: Complex64::new(-1.0, 0.0), ..plain }
            }
            Action::Channel { driving: Some(index), .. } => {
                Inversion { driving: s * s * self.values[*index], ..plain }
            }
            _ => plain,
        }
    }

    /// The receptances of FRF `k`.
    fn local(&self, k: usize) -> Local {
        let indices = &self.indices[k];
        let mut local = Local {
            whole: self.values[indices.whole],
            out: [Complex64::ZERO; MOST],
            into: [Complex64::ZERO; MOST],
        };
        for v in 0..self.count {
            local.out[v] = self.values[indices.from_sites[v]];
            local.into[v] = self.values[indices.to_sites[v]];
        }
        local
    }

    /// Adds the mass of FRF `k`'s own sensor, if it has one, to the structure that it reads; whether it has.
    fn loaded(&self, k: usize, s: Complex64, local: &mut Local, own: &Among, among: &mut Among) -> bool {
        let Some(load) = &self.indices[k].load else { return false };
        let at = |index: usize| self.values[index];
        let inertia = s * s * load.mass;
        let reaction = inertia / (1.0 + inertia * at(load.driving));
        let (out, into) = (at(load.to_response), at(load.from_reference));
        local.whole -= reaction * out * into;
        for v in 0..self.count {
            local.out[v] -= reaction * out * at(load.to_sites[v]);
            local.into[v] -= reaction * at(load.to_sites[v]) * into;
            for w in 0..self.count {
                among[v][w] = own[v][w] - reaction * at(load.to_sites[v]) * at(load.to_sites[w]);
            }
        }
        true
    }
}

/// ΔH = −G_od (k⁻¹/δ + G_dd)⁻¹ G_di written without the inverse of k, d the joint's relative motion.
fn joint(
    response: &mut RationalResponse,
    local: &Local,
    among: &Among,
    factor: Complex64,
    k: [f64; 3],
    length: f64,
) {
    let relative = |g: &[Complex64; MOST]| [g[2] - g[0] - g[1] * length, g[3] - g[1]];
    let (out, into) = (relative(&local.out), relative(&local.into));
    let rows = [0, 1, 2, 3].map(|v| relative(&among[v]));
    let column = |j: usize| relative(&[rows[0][j], rows[1][j], rows[2][j], rows[3][j]]);
    let ([g11, g21], [g12, g22]) = (column(0), column(1));
    let force = [k[0] * into[0] + k[1] * into[1], k[1] * into[0] + k[2] * into[1]];
    let determinant = k[0] * k[2] - k[1] * k[1];
    response.linear = -factor * (out[0] * force[0] + out[1] * force[1]);
    response.square = -factor
        * determinant
        * (out[0] * (g22 * into[0] - g12 * into[1]) + out[1] * (g11 * into[1] - g21 * into[0]));
    response.lower_linear = k[0] * g11 + k[1] * (g12 + g21) + k[2] * g22;
    response.lower_square = determinant * (g11 * g22 - g12 * g21);
}

fn action(fixture: &Fixture, site: &Site, pairs: &[FrfPair]) -> Option<(Vec<Station>, Action)> {
    let ends = |joint: &jointscope_fixture::Joint| -> Vec<Station> {
        [joint.from, joint.to]
            .iter()
            .flat_map(|p| {
                let point = &fixture.points()[*p];
                Station::both(point.body, point.x.value)
            })
            .collect()
    };
    match site {
        Site::Body { body, x } => {
            let body = fixture.bodies().iter().position(|b| b.name == *body)?;
            Some((vec![Station::transverse(body, *x)], Action::Body))
        }
        Site::Series { joint, point, dof } => {
            let joint = fixture.joint(joint)?;
            let near = point.as_ref().is_some_and(|name| fixture.points()[joint.from].name == *name);
            let end = if near { 0 } else { 2 } + usize::from(*dof == Dof::Rotation);
            Some((ends(joint), Action::Series { element: JointElement::new(fixture, joint), end }))
        }
        Site::Joint(name) => {
            let joint = fixture.joint(name)?;
            let here = |place: &Place| matches!(place, Place::Joint(other) if other == name);
            let at_its_ends = |place: &Place| matches!(place, Place::Point(p) if [joint.from, joint.to].iter().any(|e| fixture.points()[*e].name == *p));
            // Inside a joint that is soft in series or has mass, a factor of its elastic part alone is
            // another expression.
            let others = fixture.physics().iter().any(|e| match e.kind.spec().entry {
                Entry::WholeJoint | Entry::InSeries => here(&e.place) || at_its_ends(&e.place),
                _ => false,
            });
            if others {
                return None;
            }
            let length = JointElement::new(fixture, joint).length();
            let k = nominal_stiffness(&joint.law, length);
            let stiffness = [k.at(0, 0), k.at(0, 1), k.at(1, 1)];
            Some((ends(joint), Action::Joint { stiffness, length }))
        }
        Site::Response(name) => {
            let rows: Vec<bool> = pairs.iter().map(|p| p.response.to_string() == *name).collect();
            rows.contains(&true)
                .then(|| (Vec::new(), Action::Channel { rows, divides: false, driving: None }))
        }
        Site::Reference(name) => {
            let rows: Vec<bool> = pairs.iter().map(|p| p.reference.to_string() == *name).collect();
            rows.contains(&true).then(|| (Vec::new(), Action::Channel { rows, divides: true, driving: None }))
        }
        Site::Position(name) => {
            let slope = channel_station(fixture, &Channel::rotational(name.clone()), Side::Response)?;
            // A rotation reads the same all along a rigid block.
            let reads = |channel: &Channel| channel.point == *name && channel.dof == Dof::Translation;
            let responses: Vec<bool> = pairs.iter().map(|p| reads(&p.response)).collect();
            let references: Vec<bool> = pairs.iter().map(|p| reads(&p.reference)).collect();
            let any = responses.contains(&true) || references.contains(&true);
            any.then(|| (vec![slope], Action::Position { responses, references }))
        }
    }
}
