//! Every channel by itself: what its FRFs have in common beside those of the others.

use crate::FrfCheck;
use crate::remark::Remark;
use crate::settings::channels::{
    FORCE_SHARE, LEAST_NOISE, LEVEL_FACTOR, NOISE_FACTOR, TURNED_COSINE, UPRIGHT_COSINE,
};
use jointscope_screening::median;
use serde::Serialize;
use std::collections::BTreeMap;

/// A channel of the recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChannelCheck {
    /// `response 3` or `reference 1`.
    pub channel: String,
    /// Number of its FRFs.
    pub frfs: usize,
    /// Median level of its FRFs against the fixture's, over that of all others; `None` where there are no
    /// others or no fixture's.
    pub level: Option<f64>,
    /// Whether all its FRFs have the opposite sign to the fixture's, and the others have not.
    pub turned: bool,
    /// Median over its FRFs of their relative noise.
    pub noise: f64,
    /// What is odd, one sentence each.
    pub odd: Vec<String>,
}

/// Whether next to all FRFs have the opposite sign to the fixture's: then it is the force that is recorded
/// the other way round.
pub(crate) fn all_turned(frfs: &[FrfCheck]) -> bool {
    let turned = frfs.iter().filter(|frf| frf.sign.is_some_and(|sign| sign < TURNED_COSINE)).count();
    frfs.len() > 1 && turned as f64 > FORCE_SHARE * frfs.len() as f64
}

/// Responses, then references, each in the order of the FRFs.
pub(crate) fn of(frfs: &[FrfCheck], remarks: &mut Vec<Remark>) -> Vec<ChannelCheck> {
    let turned = |frf: &FrfCheck| frf.sign.is_some_and(|sign| sign < TURNED_COSINE);
    let upright = |frf: &FrfCheck| frf.sign.is_some_and(|sign| sign > UPRIGHT_COSINE);
    let mut channels = Vec::new();
    for is_reference in [false, true] {
        let name = |frf: &FrfCheck| match is_reference {
            true => format!("reference {}", frf.frf.reference),
            false => format!("response {}", frf.frf.response),
        };
        let mut order: BTreeMap<String, usize> = BTreeMap::new();
        for frf in frfs {
            let next = order.len();
            order.entry(name(frf)).or_insert(next);
        }
        let mut names: Vec<(String, usize)> = order.into_iter().collect();
        names.sort_by_key(|(_, place)| *place);
        for (channel, _) in names {
            let (own, others): (Vec<&FrfCheck>, Vec<&FrfCheck>) =
                frfs.iter().partition(|frf| name(frf) == channel);
            channels.push(checked(channel, &own, &others, &turned, &upright));
        }
    }
    explained_once(&mut channels, frfs);
    for channel in &channels {
        remarks.extend(channel.odd.iter().map(|says| Remark::odd(&channel.channel, says)));
    }
    let by_channel = channels.iter().any(|channel| channel.turned);
    for frf in frfs.iter().filter(|frf| turned(frf) && !by_channel) {
        let says = if frfs.len() == 1 {
            "it has the opposite sign to the fixture's FRF: sensor or hammer points the other way, or the points' order in the fixture is wrong; turn one of the two with --map, or correct the file"
        } else {
            "it has the opposite sign to the fixture's FRF, and neither all of its response nor of its reference have: check the directions of this record, and the points' order in the fixture"
        };
        remarks.push(Remark::odd(frf.frf.to_string(), says));
    }
    channels
}

/// What a turned channel has to say of it.
const SAYS_TURNED: &str = "its FRFs have the opposite sign to the fixture's, those of the other channels have not: it points the other way; turn its direction with --map, or correct the file (for modes and mass line here it is turned)";

/// An FRF that is turned has one turned channel: where all FRFs of a channel are those of turned channels of
/// the other kind, the one with more of them explains it, the response where both have as many.
fn explained_once(channels: &mut [ChannelCheck], frfs: &[FrfCheck]) {
    let before: Vec<(String, usize)> = channels
        .iter()
        .filter(|channel| channel.turned)
        .map(|channel| (channel.channel.clone(), channel.frfs))
        .collect();
    let turned = |name: &str| before.iter().find(|(channel, _)| channel == name).map(|(_, frfs)| *frfs);
    for channel in channels.iter_mut().filter(|channel| channel.turned) {
        let explained = frfs.iter().all(|frf| {
            let (response, reference) =
                (format!("response {}", frf.frf.response), format!("reference {}", frf.frf.reference));
            match &channel.channel {
                own if *own == response => turned(&reference).is_some_and(|others| others > channel.frfs),
                own if *own == reference => turned(&response).is_some_and(|others| others >= channel.frfs),
                _ => true,
            }
        });
        if explained {
            channel.turned = false;
            channel.odd.retain(|says| says != SAYS_TURNED);
        }
    }
}

fn checked(
    channel: String,
    own: &[&FrfCheck],
    others: &[&FrfCheck],
    turned: &dyn Fn(&FrfCheck) -> bool,
    upright: &dyn Fn(&FrfCheck) -> bool,
) -> ChannelCheck {
    let level_of = |frfs: &[&FrfCheck]| median(frfs.iter().filter_map(|frf| frf.level).collect());
    let noise_of = |frfs: &[&FrfCheck]| median(frfs.iter().map(|frf| frf.noise).collect());
    let level = level_of(own).zip(level_of(others)).map(|(own, others)| own / others);
    let noise = noise_of(own).unwrap_or(0.0);
    // Others of which most are turned say that it is the rest that is right.
    let most_upright = 2 * others.iter().filter(|frf| upright(frf)).count() > others.len();
    let is_turned = own.iter().all(|frf| turned(frf)) && most_upright;
    let mut odd = Vec::new();
    if is_turned {
        odd.push(SAYS_TURNED.to_owned());
    }
    if let Some(level) = level
        && !(LEVEL_FACTOR.recip()..=LEVEL_FACTOR).contains(&level)
        && own.len() > 1
    {
        odd.push(format!(
            "it reads {level:.2} times what the other channels do beside the fixture: its calibration, its place, or physics that the fixture leaves out there"
        ));
    }
    if let Some(others) = noise_of(others)
        && noise > LEAST_NOISE
        && noise > NOISE_FACTOR * others
    {
        odd.push(format!(
            "its noise is {:.0} % of the signal, {:.0} times that of the other channels: a loose sensor, a bad cable or a range set too high",
            100.0 * noise,
            noise / others
        ));
    }
    ChannelCheck { channel, frfs: own.len(), level, turned: is_turned, noise, odd }
}
