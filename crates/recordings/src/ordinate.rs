//! What an FRF's ordinates are: form and factor to SI, from data types, units labels, dataset 164 and the
//! analyst's word.

use std::collections::BTreeSet;

use jointscope_spectra::{Dof, FrfForm};
use jointscope_uff::{Axis, Dataset58, data_type};

use crate::assumed_units::{FORMS, motion_name};
use crate::datasets::motion_axis;
use crate::unit::{Dimension, Unit};
use crate::{AssumedUnits, FileChannel, UnitsError};

/// What the ordinates of an FRF are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ordinate {
    pub form: FrfForm,
    /// What the values are multiplied by to become SI.
    pub si: f64,
}

/// What was done about units, once a file however many functions it was done to.
#[derive(Debug, Default)]
pub(crate) struct UnitNotes {
    /// File and sentence.
    texts: BTreeSet<(String, String)>,
    /// Whether the analyst's word was needed anywhere.
    assumed: bool,
}

impl UnitNotes {
    /// The sentences, beginning with that on an analyst's word that was given in vain.
    pub(crate) fn into_texts(self, assumed: Option<&AssumedUnits>) -> Vec<String> {
        let in_vain = assumed.filter(|_| !self.assumed);
        let in_vain =
            in_vain.map(|_| "the files state all their units: `--assume-units` was not needed".to_owned());
        let texts = self.texts.into_iter().map(|(source, text)| format!("{source}: {text}"));
        in_vain.into_iter().chain(texts).collect()
    }
}

/// A function whose units are asked for: the name of its file and itself.
pub(crate) type Named<'a> = (&'a str, &'a Dataset58);

/// Data type of a quantity that is no motion, or no force, where the other was expected.
pub(crate) struct NotPerForce {
    pub numerator: i32,
    pub denominator: i32,
}

/// Form and factor of an FRF; `Ok(Err(..))` where the file says clearly that it is no motion per force.
pub(crate) fn ordinate(
    (source, dataset): Named,
    assumed: Option<&AssumedUnits>,
    notes: &mut UnitNotes,
) -> Result<Result<Ordinate, NotPerForce>, UnitsError> {
    let (numerator, denominator) = (&dataset.ordinate_axis, &dataset.denominator_axis);
    let is_motion = stated_form(numerator).is_some() || open(numerator);
    let is_per_force = denominator.data_type == data_type::EXCITATION_FORCE || open(denominator);
    if !is_motion || !is_per_force {
        return Ok(Err(NotPerForce { numerator: numerator.data_type, denominator: denominator.data_type }));
    }
    let mut reading = Reading { source, dataset, assumed, notes };
    let (response, reference) = (FileChannel::from(&dataset.response), FileChannel::from(&dataset.reference));
    let force = Side { name: "force", axis: denominator, channel: reference, form: None };
    let motion_label = Label::of(numerator, "response")?;
    let force_label = Label::of(denominator, "force")?;
    let form = match stated_form(numerator) {
        Some(form) => form,
        None => reading.form_by_units(response, &force, motion_label)?,
    };
    let motion = Side { name: "response", axis: numerator, channel: response, form: Some(form) };
    let si = match motion_label {
        Label::Unit(unit) if unit.dimension == motion.dimension().over(force.dimension()) => {
            reading.ratio(&motion, &force, unit, force_label)?
        }
        _ => reading.factor(&motion, motion_label)? / reading.factor(&force, force_label)?,
    };
    Ok(Ok(Ordinate { form, si }))
}

/// What one channel of a time history measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Signal {
    /// An exciting force or moment.
    Force,
    /// A motion: displacement, velocity or acceleration, by the form of FRF it is the numerator of.
    Motion(FrfForm),
}

/// Signal and factor to SI of a time history; `Ok(None)` where the file says clearly that it is neither force
/// nor motion.
pub(crate) fn signal(
    (source, dataset): Named,
    assumed: Option<&AssumedUnits>,
    notes: &mut UnitNotes,
) -> Result<Option<(Signal, f64)>, UnitsError> {
    let axis = &dataset.ordinate_axis;
    let channel = FileChannel::from(&dataset.response);
    let mut reading = Reading { source, dataset, assumed, notes };
    let force = Side { name: "force", axis, channel, form: None };
    if axis.data_type == data_type::EXCITATION_FORCE {
        return Ok(Some((Signal::Force, reading.factor(&force, Label::of(axis, "force")?)?)));
    }
    if stated_form(axis).is_none() && !open(axis) {
        return Ok(None);
    }
    let label = Label::of(axis, "response")?;
    let form = match (stated_form(axis), label) {
        (Some(form), _) => form,
        (None, Label::Unit(unit)) if unit.dimension == force.dimension() => {
            return Ok(Some((Signal::Force, reading.factor(&force, label)?)));
        }
        // Which of the two an unlabelled channel is, the analyst's pair of units does not say.
        (None, Label::Nothing | Label::Si) => {
            return Err(UnitsError::NoQuantity { data_type: axis.data_type });
        }
        _ => reading.form_by_units(channel, &force, label)?,
    };
    let motion = Side { name: "response", axis, channel, form: Some(form) };
    Ok(Some((Signal::Motion(form), reading.factor(&motion, label)?)))
}

/// Seconds in one unit of a time history's abscissa.
pub(crate) fn seconds(axis: &Axis) -> Result<f64, UnitsError> {
    let factor = match axis.units.trim().to_lowercase().as_str() {
        "" | "none" | "s" | "sec" | "second" | "seconds" | "si" => Some(1.0),
        "ms" | "msec" => Some(1e-3),
        "us" | "µs" | "μs" => Some(1e-6),
        _ => None,
    };
    let is_time = matches!(axis.data_type, data_type::TIME | data_type::UNKNOWN | data_type::GENERAL);
    factor
        .filter(|_| is_time)
        .ok_or_else(|| UnitsError::NotTime { data_type: axis.data_type, label: axis.units.clone() })
}

/// Hz in one unit of the abscissa.
pub(crate) fn hertz(axis: &Axis) -> Result<f64, UnitsError> {
    let label = axis.units.trim().to_lowercase().replace("sec", "s");
    let factor = match label.as_str() {
        "" | "none" | "hz" | "1/s" | "si" => Some(1.0),
        "khz" => Some(1e3),
        "rad/s" => Some(1.0 / std::f64::consts::TAU),
        _ => None,
    };
    let is_frequency =
        matches!(axis.data_type, data_type::FREQUENCY | data_type::UNKNOWN | data_type::GENERAL);
    factor
        .filter(|_| is_frequency)
        .ok_or_else(|| UnitsError::Abscissa { data_type: axis.data_type, label: axis.units.clone() })
}

/// What a units label says.
#[derive(Clone, Copy)]
enum Label {
    Nothing,
    /// `SI`, whatever the quantity.
    Si,
    Unit(Unit),
}

impl Label {
    fn of(axis: &Axis, name: &'static str) -> Result<Label, UnitsError> {
        let text = axis.units.trim();
        match text.to_lowercase().as_str() {
            "" | "none" | "unknown" | "n/a" | "na" | "-" => Ok(Label::Nothing),
            "si" => Ok(Label::Si),
            _ => Unit::parse(text)
                .map(Label::Unit)
                .ok_or_else(|| UnitsError::Unknown { axis: name, label: text.to_owned() }),
        }
    }
}

/// The motion or the force of a function.
struct Side<'a> {
    /// As messages call it.
    name: &'static str,
    axis: &'a Axis,
    channel: FileChannel,
    /// Form of the motion; `None` of a force.
    form: Option<FrfForm>,
}

impl Side<'_> {
    fn is_rotational(&self) -> bool {
        self.channel.is_rotational()
    }

    fn dimension(&self) -> Dimension {
        self.dimension_of(self.is_rotational())
    }

    fn dimension_of(&self, rotational: bool) -> Dimension {
        match self.form {
            Some(form) => Dimension::motion(form.order(), rotational),
            None if rotational => Dimension::MOMENT,
            None => Dimension::FORCE,
        }
    }

    /// What it measures, in the plural.
    fn what(&self) -> &'static str {
        match (self.form, self.is_rotational()) {
            (Some(_), true) => "rotations",
            (Some(form), false) => motion_name(form),
            (None, true) => "moments",
            (None, false) => "forces",
        }
    }

    fn label(&self) -> String {
        self.axis.units.trim().to_owned()
    }

    fn contradiction(&self) -> UnitsError {
        UnitsError::Contradiction {
            axis: self.name,
            data_type: self.axis.data_type,
            quantity: match self.form {
                Some(form) if self.is_rotational() => format!("rotational {}", motion_name(form)),
                _ => self.what().to_owned(),
            },
            label: self.axis.units.clone(),
        }
    }
}

/// One function whose units are being read.
struct Reading<'a> {
    source: &'a str,
    dataset: &'a Dataset58,
    assumed: Option<&'a AssumedUnits>,
    notes: &'a mut UnitNotes,
}

impl Reading<'_> {
    /// The form, where the data type leaves it open.
    fn form_by_units(
        &self,
        response: FileChannel,
        force: &Side,
        label: Label,
    ) -> Result<FrfForm, UnitsError> {
        let form = match label {
            Label::Unit(unit) => FORMS.into_iter().find(|form| {
                let motion = Dimension::motion(form.order(), response.is_rotational());
                unit.dimension == motion || unit.dimension == motion.over(force.dimension())
            }),
            Label::Nothing if !response.is_rotational() => self.assumed.map(|assumed| assumed.form),
            _ => None,
        };
        form.ok_or_else(|| absent("response", &self.dataset.ordinate_axis))
    }

    /// SI units in one of the file's, from three witnesses: label, unit system and the analyst. Where none of
    /// them speaks, the format's default is SI.
    fn factor(&mut self, side: &Side, label: Label) -> Result<f64, UnitsError> {
        let by_label = self.factor_by_label(side, label)?;
        let assumed = self.assumed.filter(|_| !side.is_rotational());
        if open(side.axis) && by_label.is_none() && assumed.is_none() {
            return Err(absent(side.name, side.axis));
        }
        let by_system = self.factor_by_system(side).filter(|_| by_label.is_some() || !open(side.axis));
        let disputed = disagree(by_label, by_system);
        let what = side.what();
        if let Some(assumed) = assumed.filter(|_| disputed || by_label.or(by_system).is_none()) {
            let unit = match side.form {
                Some(form) if form != assumed.form => {
                    let (assumed, stated) = (motion_name(assumed.form), motion_name(form));
                    return Err(UnitsError::Assumed { assumed, stated });
                }
                Some(_) => &assumed.response,
                None => &assumed.force,
            };
            let why = if disputed { "label and dataset 164 disagree" } else { "the file states no unit" };
            self.note_assumed(format!("{what}: {why}, `{}` taken as `--assume-units` says", unit.text));
            return Ok(unit.si);
        }
        if disputed {
            return Err(self.disputed(side));
        }
        match (by_label, by_system) {
            (None, None) => {
                self.note(format!("{what}: the file states no unit, SI taken, the format's default"))
            }
            (Some(1.0), _) | (None, Some(1.0)) => {}
            (Some(_), _) => self.note(format!("{what} in `{}` were converted to SI", side.label())),
            (None, Some(_)) => self.note(format!(
                "{what} in the unit system `{}` (dataset 164) were converted to SI",
                self.system()
            )),
        }
        Ok(by_label.or(by_system).unwrap_or(1.0))
    }

    fn factor_by_label(&mut self, side: &Side, label: Label) -> Result<Option<f64>, UnitsError> {
        match label {
            Label::Nothing => Ok(None),
            Label::Si => Ok(Some(1.0)),
            Label::Unit(unit) if unit.dimension == side.dimension() => Ok(Some(unit.si)),
            // Exporters print the SI label of a translation beside rotations: data type and direction say
            // what it is, and the label that it is SI.
            Label::Unit(unit) if side.is_rotational() && unit.is_si(side.dimension_of(false)) => {
                let unit = if side.form.is_some() { "rad" } else { "N m" };
                let what = side.what();
                self.note(format!("{what} carry the label of a translation in SI units, `{unit}` taken"));
                Ok(Some(1.0))
            }
            Label::Unit(_) => Err(side.contradiction()),
        }
    }

    /// SI units in one of the unit system in force, if there is any.
    fn factor_by_system(&self, side: &Side) -> Option<f64> {
        let axis = side.form.map_or_else(Axis::excitation_force, |form| motion_axis(form, Dof::Translation));
        // A scalar channel counts as a translation.
        let direction = if side.channel.direction == 0 { 2 } else { side.channel.direction };
        self.dataset.units.as_ref().map(|units| units.si_per_unit(axis.unit_exponents(direction)))
    }

    /// The factor of a label that states motion per force, such as `g/lbf`.
    fn ratio(
        &mut self,
        motion: &Side,
        force: &Side,
        unit: Unit,
        force_label: Label,
    ) -> Result<f64, UnitsError> {
        if let Label::Unit(stated) = force_label
            && stated.dimension != force.dimension()
        {
            // The error of a force that is none.
            self.factor(force, force_label)?;
        }
        let label = motion.label();
        let by_system = self
            .factor_by_system(motion)
            .zip(self.factor_by_system(force))
            .map(|(motion, force)| motion / force);
        if !disagree(Some(unit.si), by_system) {
            if unit.si != 1.0 {
                self.note(format!("FRFs in `{label}` were converted to SI"));
            }
            return Ok(unit.si);
        }
        let rotational = motion.is_rotational() || force.is_rotational();
        match self.assumed.filter(|assumed| Some(assumed.form) == motion.form && !rotational) {
            None => Err(self.disputed(motion)),
            Some(AssumedUnits { response, force, .. }) => {
                self.note_assumed(format!(
                    "FRFs in `{label}`: label and dataset 164 disagree, `{}` per `{}` taken as `--assume-units` says",
                    response.text, force.text
                ));
                Ok(response.si / force.si)
            }
        }
    }

    fn system(&self) -> &str {
        self.dataset.units.as_ref().map_or("", |units| units.description.trim())
    }

    fn disputed(&self, side: &Side) -> UnitsError {
        UnitsError::System { axis: side.name, label: side.label(), system: self.system().to_owned() }
    }

    fn note(&mut self, text: String) {
        self.notes.texts.insert((self.source.to_owned(), text));
    }

    fn note_assumed(&mut self, text: String) {
        self.notes.assumed = true;
        self.note(text);
    }
}

fn absent(axis: &'static str, stated: &Axis) -> UnitsError {
    UnitsError::Absent { axis, data_type: stated.data_type, label: stated.units.clone() }
}

/// The form of the FRFs of which an axis is the numerator, where its data type tells.
fn stated_form(axis: &Axis) -> Option<FrfForm> {
    match axis.data_type {
        data_type::DISPLACEMENT => Some(FrfForm::Receptance),
        data_type::VELOCITY => Some(FrfForm::Mobility),
        data_type::ACCELERATION => Some(FrfForm::Accelerance),
        _ => None,
    }
}

/// Whether an axis is one of a force, or its data type leaves that open.
pub(crate) fn may_be_force(axis: &Axis) -> bool {
    axis.data_type == data_type::EXCITATION_FORCE || open(axis)
}

/// Whether the data type leaves open what the axis is.
fn open(axis: &Axis) -> bool {
    matches!(axis.data_type, data_type::UNKNOWN | data_type::GENERAL)
}

/// Whether label and unit system part by more than a thousandth, which two roundings of one factor may:
/// printed unit systems hold few digits.
fn disagree(by_label: Option<f64>, by_system: Option<f64>) -> bool {
    matches!((by_label, by_system), (Some(l), Some(s)) if (l - s).abs() > 1e-3 * s.abs())
}
