//! What `stiffness.json` says of a case, as far as a row of a table holds it.

use serde_json::Value;

use crate::diagnosed::spelled;

/// A case that was decomposed.
#[derive(Debug, Clone, PartialEq)]
pub struct DecomposedCase {
    /// The joint's name.
    pub joint: String,
    /// `sound`, `with_care` or `unusable`.
    pub verdict: String,
    /// k11, k12, k22, c11, c12, c22 of the joint from all FRFs with their deviations, SI; where there is no
    /// such fit, what is known of them otherwise is in the file.
    pub numbers: [Option<(f64, f64)>; 6],
    /// The joint's mass and its deviation, kg, where the FRFs show one.
    pub mass: Option<(f64, f64)>,
    /// The most probable law over frequency, and its probability.
    pub law: Option<(String, Option<f64>)>,
    /// The law that the numbers are of, and the frequency at which they are stated, Hz; where the file says
    /// it.
    pub follows: Option<(String, f64)>,
    /// The loss factor of k11 of a structural joint, and its deviation.
    pub loss_factor: Option<(f64, f64)>,
    /// χ² per degree of freedom of the joint from all FRFs.
    pub chi2_per_dof: Option<f64>,
    /// Why there is no joint from all FRFs.
    pub failed: Option<String>,
}

/// Names of the numbers, and their places in k or c.
pub(crate) const NUMBERS: [(&str, &str, (usize, usize)); 6] = [
    ("k11", "stiffness", (0, 0)),
    ("k12", "stiffness", (0, 1)),
    ("k22", "stiffness", (1, 1)),
    ("c11", "damping", (0, 0)),
    ("c12", "damping", (0, 1)),
    ("c22", "damping", (1, 1)),
];

impl DecomposedCase {
    /// Of the contents of `stiffness.json`; `None` where they are no decomposition.
    pub(crate) fn of(file: &Value) -> Option<Self> {
        let only = |joints: &'_ Value| match joints.as_array().map(Vec::as_slice) {
            Some([only]) => Some(only.clone()),
            _ => None,
        };
        // A joint in a loop stands in a list of its own.
        let joint = &file.get("joint").cloned().or_else(|| only(file.get("joints")?))?;
        let text = |value: Option<&Value>| value.and_then(Value::as_str).map(str::to_owned);
        let at = |of: Option<&Value>, (i, j): (usize, usize)| of?.get(i)?.get(j)?.as_f64();
        let number = |(_, key, place): (&str, &str, (usize, usize))| {
            let value = at(joint.get(key), place)?;
            Some((value, at(joint.get("std").and_then(|std| std.get(key)), place)?))
        };
        let law = joint.get("law").and_then(Value::as_str).map(|law| {
            let laws = joint.get("laws").and_then(Value::as_array);
            let own = laws
                .into_iter()
                .flatten()
                .find(|entry| entry.get("law").and_then(Value::as_str) == Some(law));
            (law.to_owned(), own.and_then(|entry| entry.get("probability")?.as_f64()))
        });
        let mass = joint
            .get("mass")
            .and_then(|mass| Some((mass.get("value")?.as_f64()?, mass.get("std")?.as_f64()?)));
        let follows = joint.get("follows");
        let of_k11 = |key: &str| at(follows?.get("loss_factor")?.get(key), (0, 0));
        Some(DecomposedCase {
            follows: follows.and_then(|own| {
                Some((own.get("law")?.as_str()?.to_owned(), own.get("frequency")?.as_f64()?))
            }),
            loss_factor: of_k11("value").zip(of_k11("std")),
            joint: text(joint.get("name"))?,
            verdict: text(file.get("judgement").and_then(|judgement| judgement.get("verdict")))
                .unwrap_or_default(),
            numbers: NUMBERS.map(number),
            mass,
            law,
            chi2_per_dof: joint.get("chi2_per_dof").and_then(Value::as_f64),
            failed: text(joint.get("failed")),
        })
    }

    pub(crate) fn head() -> Vec<String> {
        let mut head: Vec<String> = ["joint", "verdict"].map(str::to_owned).into();
        for (name, ..) in NUMBERS {
            head.extend([name.to_owned(), format!("{name}_std")]);
        }
        head.extend(
            [
                "mass",
                "mass_std",
                "law",
                "law_probability",
                "law_of_numbers",
                "stated_at_hz",
                "loss_factor_11",
                "loss_factor_11_std",
                "chi2_per_dof",
                "says",
            ]
            .map(str::to_owned),
        );
        head
    }

    pub(crate) fn cells(&self) -> Vec<String> {
        let number = |value: Option<f64>| value.map(spelled).unwrap_or_default();
        let mut cells = vec![self.joint.clone(), self.verdict.clone()];
        for pair in self.numbers.iter().chain([&self.mass]) {
            cells.extend([number(pair.map(|(value, _)| value)), number(pair.map(|(_, std)| std))]);
        }
        cells.push(self.law.as_ref().map(|(law, _)| law.clone()).unwrap_or_default());
        cells.push(number(self.law.as_ref().and_then(|(_, probability)| *probability)));
        cells.push(self.follows.as_ref().map(|(law, _)| law.clone()).unwrap_or_default());
        cells.push(number(self.follows.as_ref().map(|(_, frequency)| *frequency)));
        cells.push(number(self.loss_factor.map(|(loss, _)| loss)));
        cells.push(number(self.loss_factor.map(|(_, std)| std)));
        cells.push(number(self.chi2_per_dof));
        cells.push(self.failed.clone().unwrap_or_default());
        cells
    }
}
