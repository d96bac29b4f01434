//! Changes to JSON that leave it JSON: what changes bytes alone seldom gets past the reader.

use serde_json::{Value, json};

/// Numbers at which something may end: of a range, of a format, of a unit.
const EDGES: [f64; 14] =
    [0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 1e-12, 1e-300, 5e-324, 1e12, 1e19, 1e160, 1e300, f64::MAX];

/// A stream of numbers of a seed (SplitMix64).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % limit.max(1) as u64) as usize
    }
}

/// Changes the first `size` bytes of `data`, at most `limit` of them; answers with how many there are now.
/// What is no JSON, or would not fit, has its bytes changed.
pub fn mutated(data: &mut [u8], size: usize, limit: usize, seed: u32) -> usize {
    let mut random = Random(seed.into());
    let parsed = match random.below(16) {
        0 => None,
        _ => serde_json::from_slice::<Value>(&data[..size]).ok(),
    };
    let Some(mut value) = parsed else { return libfuzzer_sys::fuzzer_mutate(data, size, limit) };
    for _ in 0..=random.below(3) {
        let mut others = Vec::new();
        gather(&value, &mut others);
        let donor = others[random.below(others.len())].clone();
        let at = random.below(others.len());
        change(&mut value, &mut { at }, donor, &mut random);
    }
    let text = value.to_string();
    if text.len() > limit {
        return libfuzzer_sys::fuzzer_mutate(data, size, limit);
    }
    data[..text.len()].copy_from_slice(text.as_bytes());
    text.len()
}

/// All values, from the outside in.
fn gather(value: &Value, into: &mut Vec<Value>) {
    into.push(value.clone());
    match value {
        Value::Array(all) => all.iter().for_each(|one| gather(one, into)),
        Value::Object(all) => all.values().for_each(|one| gather(one, into)),
        _ => {}
    }
}

/// Changes the value that `left` others precede.
fn change(value: &mut Value, left: &mut usize, donor: Value, random: &mut Random) -> bool {
    if *left == 0 {
        alter(value, donor, random);
        return true;
    }
    *left -= 1;
    match value {
        Value::Array(all) => all.iter_mut().any(|one| change(one, left, donor.clone(), random)),
        Value::Object(all) => all.values_mut().any(|one| change(one, left, donor.clone(), random)),
        _ => false,
    }
}

fn alter(value: &mut Value, donor: Value, random: &mut Random) {
    match (random.below(4), &mut *value) {
        (0, _) => *value = donor,
        (1, _) => *value = [Value::Null, json!([]), json!({}), json!(""), json!(true)][random.below(5)].clone(),
        (_, Value::Array(all)) if !all.is_empty() => {
            let (one, other) = (random.below(all.len()), random.below(all.len()));
            match random.below(3) {
                0 => drop(all.remove(one)),
                1 => all.insert(one, all[other].clone()),
                _ => all.swap(one, other),
            }
        }
        (_, Value::Object(all)) if !all.is_empty() => {
            let keys: Vec<String> = all.keys().cloned().collect();
            let one = &keys[random.below(keys.len())];
            match random.below(3) {
                0 => drop(all.remove(one)),
                1 => drop(all.insert(format!("{one}2"), all[one].clone())),
                _ => drop(all.insert(one.clone(), donor)),
            }
        }
        (_, Value::Number(number)) => {
            let old = number.as_f64().unwrap_or(1.0);
            let edge = EDGES[random.below(EDGES.len())];
            *value = match random.below(4) {
                0 => json!(edge),
                1 => json!(-old),
                2 => json!(old * edge),
                _ => json!(old * (1.0 + (random.below(2001) as f64 - 1000.0) / 500.0)),
            };
        }
        _ => *value = donor,
    }
}
