//! The dynamic stiffness of one joint with everything that the fixture says of it.

mod heavy_beam;
mod in_time;
mod two_ends;

pub(crate) use in_time::JointInTime;
pub(crate) use two_ends::TwoEnds;

use crate::effects::{Action, Change, Interface, actions};
use crate::lanes::Lines;
use crate::nominal_stiffness::nominal_stiffness;
use crate::point_law::relaxed;
use heavy_beam::HeavyBeam;
use jointscope_fixture::{Damping, Dof, Fixture, Joint, JointLaw};
use jointscope_linalg::{ComplexMatrix2, Matrix2, RealMatrix2};
use num_complex::Complex64;

/// Everything that the fixture says of one joint's dynamic stiffness.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointDynamics {
    nominal: RealMatrix2,
    length: f64,
    /// η of the fixture: its structural part belongs to the modes.
    base_loss: f64,
    dashpots: Option<RealMatrix2>,
    bending_stiffness: Option<f64>,
    extra_length: f64,
    factor: f64,
    loss: f64,
    relaxations: Vec<(f64, f64)>,
    interfaces: Vec<Interface>,
    shear_stiffness: Option<f64>,
    mass: f64,
    /// A beam with mass.
    heavy_beam: Option<Box<HeavyBeam>>,
    altered: bool,
}

impl JointDynamics {
    pub(crate) fn new(fixture: &Fixture, joint: &Joint) -> Self {
        let length = fixture.joint_length(joint);
        let (bending_stiffness, dashpots) = match &joint.law {
            JointLaw::Beam { youngs_modulus, second_moment } => {
                (Some(youngs_modulus.value * second_moment.value), None)
            }
            JointLaw::Stiffness { damping, .. } => {
                (None, damping.map(|[a, b, d]| Matrix2::new(a.value, b.value, b.value, d.value)))
            }
        };
        let base_loss = match fixture.damping() {
            Damping::LossFactor(factor) => factor.value,
            _ => 0.0,
        };
        let mut all = JointDynamics {
            nominal: nominal_stiffness(&joint.law, length),
            length,
            base_loss,
            altered: dashpots.is_some(),
            dashpots,
            bending_stiffness,
            extra_length: 0.0,
            factor: 1.0,
            loss: 0.0,
            relaxations: Vec::new(),
            interfaces: Vec::new(),
            shear_stiffness: None,
            mass: 0.0,
            heavy_beam: None,
        };
        for action in actions(fixture) {
            match action {
                Action::OnJoint { joint: index, change } if fixture.joints()[index].name == joint.name => {
                    all.apply(change);
                }
                _ => {}
            }
        }
        let length = all.length + all.extra_length;
        let beam = all.bending_stiffness.filter(|_| all.mass != 0.0 && length > 0.0);
        all.heavy_beam =
            beam.map(|bending| Box::new(HeavyBeam::new(bending, all.shear_stiffness, all.mass, length)));
        all
    }

    fn apply(&mut self, change: Change) {
        match change {
            Change::Shear { stiffness, .. } => {
                // Two shear compliances in series add up.
                let earlier = self.shear_stiffness.map_or(0.0, |s| 1.0 / s);
                self.shear_stiffness = Some(1.0 / (earlier + 1.0 / stiffness));
            }
            Change::Mass(mass) => self.mass += mass,
            Change::Factor(factor) => self.factor *= factor,
            Change::Loss(loss) => self.loss += loss,
            Change::Relaxation { ratio, time } => self.relaxations.push((ratio, time)),
            Change::Length(dx) => self.extra_length += dx,
            Change::Interface(interface) => self.interfaces.push(interface),
        }
        self.altered = true;
    }

    /// Whether anything differs from what the modes of the free assembly hold already.
    pub(crate) fn is_altered(&self) -> bool {
        self.altered
    }

    /// Whether mass of its own keeps it from being a stiffness on the relative motion of its ends alone.
    pub(crate) fn is_heavy(&self) -> bool {
        self.mass != 0.0
    }

    /// The length over which its far end's motion is compared with its near end's: with what an effect adds,
    /// or as the modes have it.
    pub(crate) fn lengths(&self) -> (f64, f64) {
        (self.length + self.extra_length, self.length)
    }

    /// The part that the modes of the free assembly hold: k(1 + iη) of the fixture on d, without its viscous
    /// damping.
    pub(crate) fn in_the_modes(&self) -> ComplexMatrix2 {
        self.nominal.to_complex().scale(Complex64::new(1.0, self.base_loss))
    }

    /// The stiffness at s = iω (or decay + iω) on d = u_to − R·u_from of a joint without mass, effects
    /// included.
    #[inline(always)]
    pub(crate) fn on_relative_motion<T: Lines>(&self, s: T) -> Matrix2<T> {
        let length = self.length + self.extra_length;
        let modulus = self.modulus(s);
        let elastic = match self.bending_stiffness {
            Some(bending) if self.extra_length != 0.0 => jointscope_beam::end_stiffness(bending, length),
            _ => self.nominal,
        };
        let mut stiffness = elastic.map(|element| modulus * element);
        if let Some(dashpots) = self.dashpots {
            stiffness = stiffness + dashpots.map(|element| s * element);
        }
        if let Some(shear) = self.shear_stiffness {
            stiffness = in_series(stiffness, [1.0, 0.0], modulus * (shear / length));
        }
        for interface in &self.interfaces {
            let direction = self.slip_at_far_end(interface, length);
            stiffness = in_series(stiffness, direction, T::ONE * interface.stiffness + s * interface.damping);
        }
        stiffness
    }

    /// The dynamic stiffness at s = iω (or decay + iω) on the motions of both ends, effects and mass
    /// included.
    #[inline(always)]
    pub(crate) fn on_both_ends<T: Lines>(&self, s: T) -> TwoEnds<T> {
        // Interfaces are springs in series with a beam's ends.
        if let Some(beam) = &self.heavy_beam {
            return self.interfaces.iter().fold(beam.at(s, self.modulus(s)), |ends, interface| {
                let spring = T::ONE * interface.stiffness + s * interface.damping;
                ends.in_series_with(interface.at_far_end, self.slip(interface), spring)
            });
        }
        let length = self.length + self.extra_length;
        let mut ends = TwoEnds::from_end(self.on_relative_motion(s), length);
        if self.mass != 0.0 {
            ends.add_half_masses(s * s * (0.5 * self.mass));
        }
        ends
    }

    /// What the slip of an interface moves the joint's end by against its body, in y and in θ.
    ///
    /// A foot that a layer holds along its length is a beam on an elastic foundation. At the edge of a long
    /// one, with β = (k'/4EI)^¼, a moment turns it by M/(EIβ) and moves it by M/(2EIβ²) (Hetényi 1946): it
    /// turns on k = EIβ about a centre 1/(2β) = EI/(2k) behind the edge. What a force moves it by beyond
    /// that, a length of 1/(2β) in bending, is left out.
    fn slip(&self, interface: &Interface) -> [f64; 2] {
        let bending = self.bending_stiffness.unwrap_or(0.0);
        let reach = interface.spread * bending / (2.0 * interface.stiffness);
        match (interface.dof, interface.at_far_end) {
            (Dof::Translation, _) => [1.0, 0.0],
            (Dof::Rotation, false) => [reach, 1.0],
            (Dof::Rotation, true) => [-reach, 1.0],
        }
    }

    /// The same in d = u_to − R·u_from, over this length.
    fn slip_at_far_end(&self, interface: &Interface, length: f64) -> [f64; 2] {
        let [y, theta] = self.slip(interface);
        if interface.at_far_end { [y, theta] } else { [y + length * theta, theta] }
    }

    /// Complex factor of the elastic stiffness: stiffness change, loss factors, relaxation.
    #[inline(always)]
    fn modulus<T: Lines>(&self, s: T) -> T {
        let mut factor = T::constant(Complex64::new(1.0, self.base_loss + self.loss));
        for &(ratio, time) in &self.relaxations {
            factor = factor + relaxed(s, time) * ratio;
        }
        factor * self.factor
    }
}

/// (k⁻¹ + r rᵀ/spring)⁻¹ = k − k r rᵀ k / (spring + rᵀ k r), which needs no inverse of k.
#[inline(always)]
fn in_series<T: Lines>(stiffness: Matrix2<T>, direction: [f64; 2], spring: T) -> Matrix2<T> {
    let [[a, b], [c, d]] = stiffness.0;
    let column = [a * direction[0] + b * direction[1], c * direction[0] + d * direction[1]];
    let row = [a * direction[0] + c * direction[1], b * direction[0] + d * direction[1]];
    let factor = (spring + column[0] * direction[0] + column[1] * direction[1]).reciprocal();
    Matrix2::new(
        a - column[0] * row[0] * factor,
        b - column[0] * row[1] * factor,
        c - column[1] * row[0] * factor,
        d - column[1] * row[1] * factor,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fixture(physics: &str) -> Fixture {
        Fixture::from_json(&format!(
            r#"{{ "bodies": {{ "A": {{ "mass": 1, "inertia": 1e-3, "x_cg": -0.03 }}, "B": {{ "mass": 1, "inertia": 1e-3, "x_cg": 0.09 }} }},
              "points": {{ "2": {{ "body": "A", "x": 0 }}, "3": {{ "body": "B", "x": 0.06 }} }},
              "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }},
              "physics": [{physics}] }}"#
        ))
        .unwrap()
    }

    fn dynamics(physics: &str) -> JointDynamics {
        let fixture = fixture(physics);
        JointDynamics::new(&fixture, &fixture.joints()[0])
    }

    fn largest_difference(a: TwoEnds<Complex64>, b: TwoEnds<Complex64>) -> f64 {
        let mut worst = 0.0_f64;
        for i in 0..4 {
            for j in 0..4 {
                let scale = (a.at(i, i).norm() * a.at(j, j).norm()).sqrt();
                worst = worst.max((a.at(i, j) - b.at(i, j)).norm() / scale);
            }
        }
        worst
    }

    #[test]
    fn a_joint_of_almost_no_mass_is_the_massless_one_whatever_else_it_has() {
        let s = Complex64::new(0.0, 3000.0);
        let others = r#"{"kind": "shear_deformation", "place": "J", "shear_stiffness": 2e6},
            {"kind": "interface_compliance", "place": "2", "dof": "rotation", "stiffness": 9e3, "damping": 0.3},
            {"kind": "interface_compliance", "place": "3", "dof": "translation", "stiffness": 8e6},
            {"kind": "loss_factor", "place": "J", "loss_factor": 0.05}, {"kind": "joint_length", "place": "J", "dx": 0.002}"#;
        let heavy = format!(r#"{others}, {{"kind": "joint_mass", "place": "J", "mass": 1e-12}}"#);
        let error = largest_difference(dynamics(others).on_both_ends(s), dynamics(&heavy).on_both_ends(s));
        assert!(error < 1e-9, "{error}");
    }

    #[test]
    fn the_mass_of_a_beam_is_right_to_the_closed_form_of_the_vibrating_beam() {
        // Clamped far end: the receptance at the free near end of a cantilever is, with z = βL, y/F = L³/(EI
        // z³) · (cosh z sin z − sinh z cos z) / (1 + cos z cosh z), here below its first resonance.
        let (ei, length, mass) = (2.07e11 * 3.67e-10, 0.06, 0.2);
        let joint = dynamics(r#"{"kind": "joint_mass", "place": "J", "mass": 0.2}"#);
        let z: f64 = 1.2;
        let omega = (z / length).powi(2) * (ei / (mass / length)).sqrt();
        let found = joint.on_both_ends(Complex64::new(0.0, omega)).near.inverse().unwrap().at(0, 0);
        let expected = length.powi(3) / (ei * z.powi(3)) * (z.cosh() * z.sin() - z.sinh() * z.cos())
            / (1.0 + z.cos() * z.cosh());
        assert!((found.re / expected - 1.0).abs() < 1e-5, "{found} against {expected}");
    }

    #[test]
    fn shear_reads_the_same_as_a_translation_spring_at_either_end() {
        let s = Complex64::new(0.0, 2000.0);
        let shear = dynamics(r#"{"kind": "shear_deformation", "place": "J", "shear_stiffness": 6e4}"#)
            .on_both_ends(s);
        for point in ["2", "3"] {
            let spring = dynamics(&format!(
                r#"{{"kind": "interface_compliance", "place": "{point}", "dof": "translation", "stiffness": 1e6}}"#
            ));
            assert!(largest_difference(shear, spring.on_both_ends(s)) < 1e-12);
        }
    }

    #[test]
    fn relaxation_stiffens_from_its_static_to_its_instantaneous_value() {
        let joint = dynamics(r#"{"kind": "relaxation", "place": "J", "ratio": 0.6, "time": 1e-4}"#);
        let nominal = joint.nominal.at(0, 0);
        let ratio = |omega: f64| joint.on_both_ends(Complex64::new(0.0, omega)).far.at(0, 0) / nominal;
        assert!((ratio(1e-3) - 1.0).norm() < 1e-6 && (ratio(1e9) - 1.6).norm() < 1e-4);
        // At ωτ = 1 the loss is half of the ratio.
        assert!((ratio(1e4) - Complex64::new(1.3, 0.3)).norm() < 1e-12);
    }

    #[test]
    fn a_rotation_spring_at_the_near_end_adds_its_compliance_about_that_end() {
        let s = Complex64::new(0.0, 1.0);
        let joint = dynamics(
            r#"{"kind": "interface_compliance", "place": "2", "dof": "rotation", "stiffness": 5e3}"#,
        );
        let with = joint.on_both_ends(s).far.inverse().unwrap();
        let without = joint.nominal.inverse().unwrap();
        let l = 0.06;
        let expected = [[l * l / 5e3, l / 5e3], [l / 5e3, 1.0 / 5e3]];
        for i in 0..2 {
            for j in 0..2 {
                let added = with.at(i, j).re - without.at(i, j);
                assert!((added / expected[i][j] - 1.0).abs() < 1e-9, "({i},{j}): {added}");
            }
        }
    }

    #[test]
    fn a_layer_along_a_foot_turns_it_as_an_elastic_foundation_does() {
        // A long beam on a foundation of k' per length, at its edge (Hetényi 1946): θ = M/(EIβ),
        // y = ±M/(2EIβ²), with β = (k'/4EI)^¼.
        let bending = 2.07e11 * 3.67e-10;
        let beta = 400.0;
        let spring = bending * beta;
        for (point, outward) in [("2", -1.0), ("3", 1.0)] {
            let at = |mass: &str| {
                dynamics(&format!(
                    r#"{{"kind": "interface_compliance", "place": "{point}", "dof": "rotation", "stiffness": {spring}, "spread": 1}}{mass}"#
                ))
            };
            let joint = at("");
            let added = |i: usize, j: usize| {
                let with = joint.on_relative_motion(Complex64::new(0.0, 1.0)).inverse().unwrap();
                with.at(i, j).re - joint.nominal.inverse().unwrap().at(i, j)
            };
            // At the far end itself, or carried to it over the joint's length from the near end.
            let arm = if outward > 0.0 { 0.0 } else { 0.06 };
            let (turned, moved) = (1.0 / (bending * beta), -outward / (2.0 * bending * beta * beta));
            assert!((added(1, 1) / turned - 1.0).abs() < 1e-9);
            assert!((added(0, 1) / (moved + arm * turned) - 1.0).abs() < 1e-9, "{}", added(0, 1));
            let heavy = at(r#", {"kind": "joint_mass", "place": "J", "mass": 1e-12}"#);
            let s = Complex64::new(0.0, 3000.0);
            let error = largest_difference(joint.on_both_ends(s), heavy.on_both_ends(s));
            assert!(error < 1e-9, "{error}");
        }
    }

    #[test]
    fn a_layer_along_a_foot_does_what_a_joint_as_much_longer_does() {
        // A massless strip that ends δ farther inside the body, seen from where its end is said to be.
        let (bending, length, longer) = (2.07e11 * 3.67e-10, 0.06, 2e-4);
        let spring = bending / longer;
        let joint = dynamics(&format!(
            r#"{{"kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": {spring}, "spread": 1}}"#
        ));
        let found = joint.on_relative_motion(Complex64::new(0.0, 1.0)).inverse().unwrap();
        let total: f64 = length + longer;
        let [yy, yt, tt] = [total.powi(3) / 3.0, total.powi(2) / 2.0, total].map(|c| c / bending);
        let expected =
            [[yy - 2.0 * longer * yt + longer.powi(2) * tt, yt - longer * tt], [yt - longer * tt, tt]];
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let error = found.at(i, j).re / expected[i][j] - 1.0;
            assert!(error.abs() < 2.0 * (longer / length).powi(2), "({i},{j}): {error}");
        }
    }
}
