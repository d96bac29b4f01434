//! Time histories of hits as functions of a universal file.

use jointscope_hits::{Hit, MeasuredMotion};
use jointscope_spectra::{Channel, FrfForm};
use jointscope_uff::{Abscissa, Axis, Data, Dataset58, Encoding, FunctionType};

use crate::DatasetsError;
use crate::datasets::{force_axis, id_lines, motion_axis, node};

/// The signals of hits as time histories (function type 1) in SI units and double precision, the hit's number
/// as sequence number. Forces come first where `with_force` asks for them. ID line 1 is `test_name`.
///
/// # Errors
/// A point whose name is no node number.
pub fn hits_to_datasets(
    hits: &[Hit],
    test_name: &str,
    encoding: Encoding,
    with_force: bool,
) -> Result<Vec<Dataset58>, DatasetsError> {
    let mut datasets = Vec::new();
    for hit in hits {
        let abscissa = Abscissa::Even { start: hit.start(), step: hit.interval(), count: hit.samples() };
        let history = |channel: &Channel, ordinate_axis: Axis, values: &[f64]| {
            Ok::<_, DatasetsError>(Dataset58 {
                id_lines: id_lines(test_name, None),
                function: FunctionType::TimeResponse,
                sequence_number: i64::from(hit.number()),
                response: node(channel)?,
                reference: node(hit.struck())?,
                abscissa_axis: Axis::time(),
                ordinate_axis,
                encoding,
                ..Dataset58::new(abscissa.clone(), Data::Real(values.to_vec()))
            })
        };
        if with_force {
            datasets.push(history(hit.struck(), force_axis(hit.struck().dof), hit.force())?);
        }
        for response in hit.responses() {
            let axis = motion_axis(form_of(response.motion), response.channel.dof);
            datasets.push(history(&response.channel, axis, &response.values)?);
        }
    }
    Ok(datasets)
}

/// The form of FRF that a motion is the numerator of.
fn form_of(motion: MeasuredMotion) -> FrfForm {
    match motion {
        MeasuredMotion::Displacement => FrfForm::Receptance,
        MeasuredMotion::Velocity => FrfForm::Mobility,
        MeasuredMotion::Acceleration => FrfForm::Accelerance,
    }
}
