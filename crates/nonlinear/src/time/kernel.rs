//! Steps of a linear system with a few amplitude-dependent forces in it.
//!
//! Between two instants the force is a straight line, element forces are parabolas through their last three
//! values, and the linear part is propagated exactly, x⁺ = Φx + β₀F + β₁F⁺ − Σ(ε₋g⁻ + ε₀g + ε₁g⁺); the new g⁺
//! follows from its law in closed form, for it moves its own d⁺ by a known amount. A step in which an element
//! changes its branch (contact, slip) is halved until the event is confined to a short one; across an event
//! and after it, element forces are straight lines.

use super::law::{Memory, RestoringLaw};
use jointscope_linalg::matrix_exponential;

/// A linear system ẋ = A x + b F − Σ eⱼgⱼ with elements on dⱼ = cⱼx and outputs yᵢ = rᵢx + aᵢF − Σ hᵢⱼgⱼ.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct System {
    /// A, row-major.
    pub matrix: Vec<f64>,
    /// b.
    pub load: Vec<f64>,
    pub elements: Vec<Element>,
    pub outputs: Vec<Output>,
}

/// An amplitude-dependent force.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Element {
    pub law: RestoringLaw,
    /// e: what a force pair of 1 loads.
    pub load: Vec<f64>,
    /// c: reads d.
    pub motion: Vec<f64>,
}

/// A reading of the system.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Output {
    pub row: Vec<f64>,
    pub force: f64,
    pub elements: Vec<f64>,
}

/// How a run steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Steps {
    /// Interval of the outputs, s.
    pub interval: f64,
    /// Steps within it.
    pub within: usize,
    /// Halvings of a step that holds an event.
    pub halvings: usize,
}

/// Largest number of states.
pub(crate) const MOST_STATES: usize = 128;
/// Largest number of elements.
pub(crate) const MOST_ELEMENTS: usize = 4;

/// A system ready to be stepped.
pub(crate) struct Stepper(Box<dyn Kernel>);

impl Stepper {
    /// `None` for more states or elements than there is room for, or a system whose exponential is not
    /// finite.
    pub(crate) fn new(system: &System, steps: Steps) -> Option<Self> {
        macro_rules! of_size {
            ($($n:literal),*) => {
                match (system.load.len(), system.elements.len()) {
                    $((n, 0) if n <= $n => Box::new(Sized::<$n, 0>::new(system, steps)?) as Box<dyn Kernel>,
                      (n, 1) if n <= $n => Box::new(Sized::<$n, 1>::new(system, steps)?),
                      (n, 2) if n <= $n => Box::new(Sized::<$n, 2>::new(system, steps)?),
                      (n, 3..=MOST_ELEMENTS) if n <= $n => Box::new(Sized::<$n, MOST_ELEMENTS>::new(system, steps)?),)*
                    _ => return None,
                }
            };
        }
        Some(Stepper(of_size!(2, 4, 6, 8, 12, 16, 24, 32, 64, 128)))
    }

    /// The history of each output from rest, through a force given at every step (`within` values an output
    /// interval); outputs are written at every `within`-th of them.
    pub(crate) fn run(&self, force: &[f64], samples: usize) -> Vec<Vec<f64>> {
        self.0.run(force, samples)
    }
}

trait Kernel: Send + Sync {
    fn run(&self, force: &[f64], samples: usize) -> Vec<Vec<f64>>;
}

/// Φ, β and ε of one length of step.
struct Propagator<const N: usize, const E: usize> {
    /// Φ by columns: a state's contributions are added side by side.
    transition: [[f64; N]; N],
    force: [[f64; N]; 2],
    /// ε of the force before the last, the last and the new one.
    elements: [[[f64; N]; 3]; E],
    /// How far each element's new force moves each element's motion.
    yields: [[f64; E]; E],
}

struct Sized<const N: usize, const E: usize> {
    /// The whole step with parabolas.
    smooth: Propagator<N, E>,
    /// The whole step, its half, its quarter …, with straight lines.
    propagators: Vec<Propagator<N, E>>,
    laws: [RestoringLaw; E],
    motions: [[f64; N]; E],
    outputs: Vec<([f64; N], f64, [f64; E])>,
    /// Steps within an output interval.
    within: usize,
}

/// A law that never bears anything: what stands where there is no element.
const NOTHING: RestoringLaw = RestoringLaw::Gap { clearance: f64::INFINITY, stiffness: 0.0 };

fn row<const N: usize>(values: &[f64]) -> [f64; N] {
    let mut all = [0.0; N];
    all.iter_mut().zip(values).for_each(|(to, from)| *to = *from);
    all
}

#[inline]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<const N: usize, const E: usize> Sized<N, E> {
    fn new(system: &System, steps: Steps) -> Option<Self> {
        let element = |j: usize| system.elements.get(j);
        let motions = std::array::from_fn(|j| element(j).map_or([0.0; N], |e| row(&e.motion)));
        let laws = std::array::from_fn(|j| element(j).map_or(NOTHING, |e| e.law));
        let halvings = if E == 0 { 0 } else { steps.halvings };
        let step = steps.interval / steps.within as f64;
        let propagators = (0..=halvings)
            .map(|halving| Propagator::new(system, step * 0.5f64.powi(halving as i32), &motions, false))
            .collect::<Option<_>>()?;
        let outputs = system.outputs.iter().map(|o| (row(&o.row), o.force, row(&o.elements))).collect();
        let smooth = Propagator::new(system, step, &motions, true)?;
        Some(Sized { smooth, propagators, laws, motions, outputs, within: steps.within })
    }

    /// One step with the propagator of `halving`; whether an event lies within it, in which case nothing is
    /// changed.
    #[inline(always)]
    fn plain_step(
        &self,
        by: &Propagator<N, E>,
        x: &mut [f64; N],
        memory: &mut [Memory; E],
        earlier: &[f64; E],
        force: [f64; 2],
        any: bool,
    ) -> bool {
        let mut free = [0.0; N];
        for i in 0..N {
            free[i] = by.force[0][i] * force[0] + by.force[1][i] * force[1];
        }
        for ((element, before), earlier) in by.elements.iter().zip(memory.iter()).zip(earlier) {
            for i in 0..N {
                free[i] -= element[0][i] * earlier + element[1][i] * before.force;
            }
        }
        for (column, value) in by.transition.iter().zip(x.iter()) {
            for i in 0..N {
                free[i] += column[i] * value;
            }
        }
        let mut after = *memory;
        if E == 1 {
            let motion = dot(&self.motions[0], &free);
            after[0] = self.laws[0].settle(motion, by.yields[0][0], &memory[0]);
        } else {
            self.settle_together(by, &free, memory, &mut after);
        }
        let event = |j: usize| self.laws[j].branch(&memory[j]) != self.laws[j].branch(&after[j]);
        if !any && (0..E).any(event) {
            return true;
        }
        for (element, now) in by.elements.iter().zip(&after) {
            for i in 0..N {
                free[i] -= element[2][i] * now.force;
            }
        }
        *x = free;
        *memory = after;
        false
    }

    #[inline(never)]
    fn halved_step(&self, halving: usize, x: &mut [f64; N], memory: &mut [Memory; E], force: [f64; 2]) {
        let middle = 0.5 * (force[0] + force[1]);
        let last = halving + 1 == self.propagators.len();
        let by = &self.propagators[halving];
        for half in [[force[0], middle], [middle, force[1]]] {
            if self.plain_step(by, x, memory, &[0.0; E], half, last) {
                self.halved_step(halving + 1, x, memory, half);
            }
        }
    }

    /// Several elements move each other: one after the other until nothing changes.
    fn settle_together(
        &self,
        by: &Propagator<N, E>,
        free: &[f64; N],
        before: &[Memory; E],
        after: &mut [Memory; E],
    ) {
        let motions: [f64; E] = std::array::from_fn(|j| dot(&self.motions[j], free));
        for _ in 0..30 {
            let mut change: f64 = 0.0;
            for j in 0..E {
                let others: f64 = (0..E).filter(|k| *k != j).map(|k| by.yields[j][k] * after[k].force).sum();
                let next = self.laws[j].settle(motions[j] - others, by.yields[j][j], &before[j]);
                change = change.max((next.force - after[j].force).abs() - 1e-10 * next.force.abs());
                after[j] = next;
            }
            if change <= 0.0 {
                break;
            }
        }
    }
}

impl<const N: usize, const E: usize> Kernel for Sized<N, E> {
    fn run(&self, force: &[f64], samples: usize) -> Vec<Vec<f64>> {
        let within = self.within;
        let mut x = [0.0; N];
        let mut memory = [Memory::default(); E];
        let mut histories = vec![Vec::with_capacity(samples); self.outputs.len()];
        let only = self.propagators.len() == 1;
        // Whether the last step held no event, so that three values of the element forces lie on one branch.
        let (mut even, mut earlier) = (false, [0.0; E]);
        let at = |step: usize| force.get(step).copied().unwrap_or(0.0);
        for sample in 0..samples {
            if sample > 0 {
                for step in (sample - 1) * within..sample * within {
                    let forces = [at(step), at(step + 1)];
                    let now = memory.map(|m| m.force);
                    let by = if even { &self.smooth } else { &self.propagators[0] };
                    even = !self.plain_step(by, &mut x, &mut memory, &earlier, forces, only);
                    if !even {
                        self.halved_step(1, &mut x, &mut memory, forces);
                    }
                    earlier = now;
                }
            }
            let now = at(sample * within);
            for (history, (row, direct, elements)) in histories.iter_mut().zip(&self.outputs) {
                let borne: f64 = elements.iter().zip(&memory).map(|(h, m)| h * m.force).sum();
                history.push(dot(row, &x) + direct * now - borne);
            }
        }
        histories
    }
}

impl<const N: usize, const E: usize> Propagator<N, E> {
    /// From the exponential of the system extended by its inputs and their rates.
    fn new(system: &System, step: f64, motions: &[[f64; N]; E], parabolas: bool) -> Option<Self> {
        let (n, loads) = (system.load.len(), 1 + system.elements.len());
        let size = n + 3 * loads;
        let mut extended = vec![0.0; size * size];
        for i in 0..n {
            for j in 0..n {
                extended[i * size + j] = system.matrix[i * n + j] * step;
            }
            extended[i * size + n] = system.load[i] * step;
            for (j, element) in system.elements.iter().enumerate() {
                extended[i * size + n + 1 + j] = element.load[i] * step;
            }
        }
        (0..2 * loads).for_each(|k| extended[(n + k) * size + n + loads + k] = 1.0);
        let exponential = matrix_exponential(&extended, size)?;
        let mut all = Propagator {
            transition: [[0.0; N]; N],
            force: [[0.0; N]; 2],
            elements: [[[0.0; N]; 3]; E],
            yields: [[0.0; E]; E],
        };
        for i in 0..n {
            for j in 0..n {
                all.transition[j][i] = exponential[i * size + j];
            }
            for k in 0..loads {
                let (held, ramp) = (exponential[i * size + n + k], exponential[i * size + n + loads + k]);
                if k == 0 {
                    all.force[0][i] = held - ramp;
                    all.force[1][i] = ramp;
                    continue;
                }
                // Of the second difference of three values: ∫Φ·½τ(τ − 1).
                let bend =
                    if parabolas { exponential[i * size + n + 2 * loads + k] - 0.5 * ramp } else { 0.0 };
                let into = &mut all.elements[k - 1];
                into[0][i] = bend;
                into[1][i] = held - ramp - 2.0 * bend;
                into[2][i] = ramp + bend;
            }
        }
        for (j, motion) in motions.iter().enumerate() {
            for k in 0..E {
                all.yields[j][k] = dot(motion, &all.elements[k][2]);
            }
        }
        Some(all)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const OMEGA: f64 = 900.0;

    /// One mass of 1 kg on a spring without damping; outputs are d, its rate, its acceleration and the
    /// element's force.
    fn oscillator(law: RestoringLaw) -> System {
        let output = |row: [f64; 2], force: f64, element: f64| Output {
            row: row.to_vec(),
            force,
            elements: vec![element],
        };
        System {
            matrix: vec![0.0, 1.0, -OMEGA * OMEGA, 0.0],
            load: vec![0.0, 1.0],
            elements: vec![Element { law, load: vec![0.0, 1.0], motion: vec![1.0, 0.0] }],
            outputs: vec![
                output([1.0, 0.0], 0.0, 0.0),
                output([0.0, 1.0], 0.0, 0.0),
                output([-OMEGA * OMEGA, 0.0], 1.0, 1.0),
                output([0.0, 0.0], 0.0, -1.0),
            ],
        }
    }

    /// A half sine of `length` intervals.
    fn blow(samples: usize, within: usize, length: usize) -> Vec<f64> {
        let at = |i: usize| i as f64 / (length * within) as f64;
        (0..=samples * within)
            .map(|i| if at(i) < 1.0 { 400.0 * (std::f64::consts::PI * at(i)).sin() } else { 0.0 })
            .collect()
    }

    const LAWS: [RestoringLaw; 3] = [
        RestoringLaw::Cubic { stiffness3: 4e11 },
        RestoringLaw::Gap { clearance: 2e-4, stiffness: 2e6 },
        RestoringLaw::Friction { slip_force: 60.0, stiffness: 1e6 },
    ];

    #[test]
    fn what_the_force_puts_in_is_kinetic_elastic_or_lost_in_friction() {
        // Every step is read, so that the sums below are as fine as the steps are.
        let (interval, samples, within) = (2.5e-6, 48_000, 1);
        for law in LAWS {
            let steps = Steps { interval, within, halvings: 8 };
            let force = blow(samples, within, 160);
            let run = Stepper::new(&oscillator(law), steps).unwrap().run(&force, samples);
            let (d, v, g) = (&run[0], &run[1], &run[3]);
            let (mut work, mut lost, mut largest) = (0.0, 0.0, 0.0f64);
            for i in 1..samples {
                work += 0.25 * interval * (force[i * within] + force[(i - 1) * within]) * (v[i] + v[i - 1]);
                if let RestoringLaw::Friction { stiffness, .. } = law {
                    let slipped = (d[i] - d[i - 1]) - (g[i] - g[i - 1]) / stiffness;
                    lost += 0.5 * (g[i - 1] + g[i]) * slipped;
                }
                let stored = match law {
                    RestoringLaw::Cubic { stiffness3 } => 0.25 * stiffness3 * d[i].powi(4),
                    RestoringLaw::Gap { stiffness, .. } | RestoringLaw::Friction { stiffness, .. } => {
                        0.5 * g[i] * g[i] / stiffness
                    }
                };
                let energy = 0.5 * v[i] * v[i] + 0.5 * (OMEGA * d[i]).powi(2) + stored;
                if force[i * within] == 0.0 {
                    largest = largest.max((energy + lost - work).abs() / work);
                }
            }
            assert!(largest < 2e-4, "{law:?}: {largest:.1e} of the work is missing");
        }
    }

    #[test]
    fn halving_the_steps_changes_next_to_nothing() {
        let (interval, samples) = (1e-4, 1500);
        for law in LAWS {
            let run = |within: usize| {
                let steps = Steps { interval, within, halvings: 10 };
                // The same straight lines for both.
                let coarse = blow(samples, 1, 20);
                let force: Vec<f64> = (0..=samples * within)
                    .map(|i| {
                        let (low, part) = (i / within, (i % within) as f64 / within as f64);
                        coarse[low] * (1.0 - part) + coarse.get(low + 1).copied().unwrap_or(0.0) * part
                    })
                    .collect();
                Stepper::new(&oscillator(law), steps).unwrap().run(&force, samples).swap_remove(0)
            };
            let (coarse, fine) = (run(4), run(16));
            let rms = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>().sqrt();
            let change: Vec<f64> = coarse.iter().zip(&fine).map(|(a, b)| a - b).collect();
            assert!(rms(&change) < 5e-3 * rms(&fine), "{law:?}: {:.1e}", rms(&change) / rms(&fine));
        }
    }

    #[test]
    fn more_states_than_there_is_room_for_are_refused() {
        let n = MOST_STATES + 1;
        let system = System {
            matrix: vec![0.0; n * n],
            load: vec![0.0; n],
            elements: Vec::new(),
            outputs: Vec::new(),
        };
        assert!(Stepper::new(&system, Steps { interval: 1e-4, within: 1, halvings: 0 }).is_none());
    }
}
