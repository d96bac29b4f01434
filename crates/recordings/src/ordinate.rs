//! What an FRF's ordinates are: form and factor to SI, from data types, units labels, dataset 164 and the analyst's word.

use std::collections::BTreeSet;

use jointscope_spectra::FrfForm;
use jointscope_uff::{Axis, Dataset58, Units, data_type};

use crate::assumed_units::{FORMS, NamedUnit, motion_name};
use crate::unit::{Dimension, Unit};
use crate::{AssumedUnits, FileChannel, UnitsError};

/// What the ordinates of an FRF are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ordinate {
    pub form: FrfForm,
    /// What the values are multiplied by to become SI.
    pub si: f64,
}

/// What was done about units, once however many functions it was done to.
#[derive(Debug, Default)]
pub(crate) struct UnitNotes {
    pub texts: BTreeSet<String>,
    /// Whether the analyst's word was needed anywhere.
    pub assumed: bool,
}

impl UnitNotes {
    fn insert(&mut self, note: String) {
        self.texts.insert(note);
    }

    fn insert_assumed(&mut self, note: String) {
        self.assumed = true;
        self.texts.insert(note);
    }
}

/// Data type of a quantity that is no motion, or no force, where the other was expected.
pub(crate) struct NotPerForce {
    pub numerator: i32,
    pub denominator: i32,
}

/// Form and factor of an FRF; `Ok(Err(..))` where the file says clearly that it is no motion per force.
pub(crate) fn ordinate(
    dataset: &Dataset58,
    assumed: Option<&AssumedUnits>,
    notes: &mut UnitNotes,
) -> Result<Result<Ordinate, NotPerForce>, UnitsError> {
    let (numerator, denominator) = (&dataset.ordinate_axis, &dataset.denominator_axis);
    let stated_form = match numerator.data_type {
        data_type::DISPLACEMENT => Some(FrfForm::Receptance),
        data_type::VELOCITY => Some(FrfForm::Mobility),
        data_type::ACCELERATION => Some(FrfForm::Accelerance),
        _ => None,
    };
    let motion = stated_form.is_some() || open(numerator);
    let per_force = denominator.data_type == data_type::EXCITATION_FORCE || open(denominator);
    if !motion || !per_force {
        return Ok(Err(NotPerForce { numerator: numerator.data_type, denominator: denominator.data_type }));
    }
    let mut reading = Reading {
        numerator,
        denominator,
        response: FileChannel::from(&dataset.response),
        reference: FileChannel::from(&dataset.reference),
        system: dataset.units.as_ref(),
        assumed,
        notes,
    };
    let motion_label = Label::of(numerator, "response")?;
    let force_label = Label::of(denominator, "force")?;
    let form = match stated_form {
        Some(form) => form,
        None => reading.form_by_units(motion_label)?,
    };
    if let Label::Unit(unit) = motion_label
        && unit.dimension == reading.motion(form).over(reading.force())
    {
        return reading.ratio(form, unit, force_label).map(Ok);
    }
    let motion = reading.motion_factor(form, motion_label)?;
    let force = reading.force_factor(force_label)?;
    Ok(Ok(Ordinate { form, si: motion / force }))
}

/// What one channel of a time history measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Signal {
    /// An exciting force or moment.
    Force,
    /// A motion: displacement, velocity or acceleration, by the form of FRF it is the numerator of.
    Motion(FrfForm),
}

/// Signal and factor to SI of a time history; `Ok(None)` where the file says clearly that it is neither force nor motion.
pub(crate) fn signal(
    dataset: &Dataset58,
    assumed: Option<&AssumedUnits>,
    notes: &mut UnitNotes,
) -> Result<Option<(Signal, f64)>, UnitsError> {
    let axis = &dataset.ordinate_axis;
    let channel = FileChannel::from(&dataset.response);
    let mut reading = Reading {
        numerator: axis,
        denominator: axis,
        response: channel,
        reference: channel,
        system: dataset.units.as_ref(),
        assumed,
        notes,
    };
    let form = match axis.data_type {
        data_type::DISPLACEMENT => FrfForm::Receptance,
        data_type::VELOCITY => FrfForm::Mobility,
        data_type::ACCELERATION => FrfForm::Accelerance,
        data_type::EXCITATION_FORCE => {
            let factor = reading.force_factor(Label::of(axis, "force")?)?;
            return Ok(Some((Signal::Force, factor)));
        }
        _ if open(axis) => {
            let label = Label::of(axis, "response")?;
            match label {
                Label::Unit(unit) if unit.dimension == reading.force() => {
                    return Ok(Some((Signal::Force, reading.force_factor(label)?)));
                }
                // Which of the two an unlabelled channel is, the analyst's pair of units does not say.
                Label::Nothing | Label::Si => {
                    return Err(UnitsError::NoQuantity { data_type: axis.data_type });
                }
                _ => reading.form_by_units(label)?,
            }
        }
        _ => return Ok(None),
    };
    let factor = reading.motion_factor(form, Label::of(axis, "response")?)?;
    Ok(Some((Signal::Motion(form), factor)))
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

/// One FRF's axes while they are being read.
struct Reading<'a> {
    numerator: &'a Axis,
    denominator: &'a Axis,
    response: FileChannel,
    reference: FileChannel,
    system: Option<&'a Units>,
    assumed: Option<&'a AssumedUnits>,
    notes: &'a mut UnitNotes,
}

/// Factors that agree to a thousandth are two roundings of one: printed unit systems hold few digits.
fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-3 * b.abs()
}

impl Reading<'_> {
    fn motion(&self, form: FrfForm) -> Dimension {
        Dimension::motion(form.order(), self.response.is_rotational())
    }

    fn force(&self) -> Dimension {
        if self.reference.is_rotational() { Dimension::MOMENT } else { Dimension::FORCE }
    }

    /// The form, where the data type leaves it open.
    fn form_by_units(&self, label: Label) -> Result<FrfForm, UnitsError> {
        let form = match label {
            Label::Unit(unit) => FORMS.into_iter().find(|form| {
                let motion = self.motion(*form);
                unit.dimension == motion || unit.dimension == motion.over(self.force())
            }),
            Label::Nothing if !self.response.is_rotational() => self.assumed.map(|assumed| assumed.form),
            _ => None,
        };
        form.ok_or_else(|| self.absent("response", self.numerator))
    }

    fn absent(&self, axis: &'static str, stated: &Axis) -> UnitsError {
        UnitsError::Absent { axis, data_type: stated.data_type, label: stated.units.clone() }
    }

    /// SI units of motion in one of the file's.
    fn motion_factor(&mut self, form: FrfForm, label: Label) -> Result<f64, UnitsError> {
        let rotational = self.response.is_rotational();
        let by_label = match label {
            Label::Nothing => None,
            Label::Si => Some(1.0),
            Label::Unit(unit) if unit.dimension == self.motion(form) => Some(unit.si),
            Label::Unit(unit) if rotational && unit.is_si(Dimension::motion(form.order(), false)) => {
                self.note_translation_label("rotations", "rad");
                Some(1.0)
            }
            Label::Unit(_) => {
                let rotation = if rotational { "rotational " } else { "" };
                return Err(UnitsError::Contradiction {
                    axis: "response",
                    data_type: self.numerator.data_type,
                    quantity: format!("{rotation}{}", motion_name(form)),
                    label: self.numerator.units.clone(),
                });
            }
        };
        let by_system = self
            .system_factor(&axis_of(form), self.response)
            .filter(|_| by_label.is_some() || !open(self.numerator));
        let what = if rotational { "rotations" } else { motion_name(form) };
        let assumed = match self.assumed {
            Some(assumed) if !rotational => {
                let needed = by_label.is_none() && by_system.is_none() || disagree(by_label, by_system);
                if needed && assumed.form != form {
                    let (assumed, stated) = (motion_name(assumed.form), motion_name(form));
                    return Err(UnitsError::Assumed { assumed, stated });
                }
                Some(&assumed.response)
            }
            _ => None,
        };
        self.decide("response", what, by_label, by_system, assumed)
    }

    /// N or N·m in one of the file's units of force.
    fn force_factor(&mut self, label: Label) -> Result<f64, UnitsError> {
        let rotational = self.reference.is_rotational();
        let by_label = match label {
            Label::Nothing => None,
            Label::Si => Some(1.0),
            Label::Unit(unit) if unit.dimension == self.force() => Some(unit.si),
            Label::Unit(unit) if rotational && unit.is_si(Dimension::FORCE) => {
                self.note_translation_label("moments", "N m");
                Some(1.0)
            }
            Label::Unit(_) => {
                return Err(UnitsError::Contradiction {
                    axis: "force",
                    data_type: self.denominator.data_type,
                    quantity: if rotational { "moments".into() } else { "forces".into() },
                    label: self.denominator.units.clone(),
                });
            }
        };
        let assumed = self.assumed.filter(|_| !rotational).map(|assumed| &assumed.force);
        if open(self.denominator) && by_label.is_none() && assumed.is_none() {
            return Err(self.absent("force", self.denominator));
        }
        let by_system = self
            .system_factor(&Axis::excitation_force(), self.reference)
            .filter(|_| by_label.is_some() || !open(self.denominator));
        self.decide("force", if rotational { "moments" } else { "forces" }, by_label, by_system, assumed)
    }

    /// Exporters print the SI label of a translation beside rotations: data type and direction say what it is, and
    /// the label that it is SI.
    fn note_translation_label(&mut self, what: &str, unit: &str) {
        self.notes.insert(format!("{what} carry the label of a translation in SI units, `{unit}` taken"));
    }

    /// The factor of one axis from its three witnesses. Where none of them speaks, the format's default is SI.
    fn decide(
        &mut self,
        axis: &'static str,
        what: &str,
        by_label: Option<f64>,
        by_system: Option<f64>,
        assumed: Option<&NamedUnit>,
    ) -> Result<f64, UnitsError> {
        let label = if axis == "response" { &self.numerator.units } else { &self.denominator.units };
        let system = self.system.map_or("", |units| units.description.trim());
        let disputed = disagree(by_label, by_system);
        let (factor, note) = match (by_label, by_system, assumed) {
            (Some(_), Some(_), None) if disputed => {
                return Err(UnitsError::System { axis, label: label.clone(), system: system.to_owned() });
            }
            (Some(_), Some(_), Some(assumed)) if disputed => {
                let text = &assumed.text;
                self.notes.insert_assumed(format!(
                    "{what}: label and dataset 164 disagree, `{text}` taken as `--assume-units` says"
                ));
                return Ok(assumed.si);
            }
            (None, None, Some(assumed)) => {
                let text = &assumed.text;
                self.notes.insert_assumed(format!(
                    "{what}: the file states no unit, `{text}` taken as `--assume-units` says"
                ));
                return Ok(assumed.si);
            }
            (None, None, None) => {
                (1.0, Some(format!("{what}: the file states no unit, SI taken, the format's default")))
            }
            (Some(factor), _, _) => (
                factor,
                (factor != 1.0).then(|| format!("{what} in `{}` were converted to SI", label.trim())),
            ),
            (None, Some(factor), _) => (
                factor,
                (factor != 1.0).then(|| {
                    format!("{what} in the unit system `{system}` (dataset 164) were converted to SI")
                }),
            ),
        };
        if let Some(note) = note {
            self.notes.insert(note);
        }
        Ok(factor)
    }

    /// A label that states motion per force, such as `g/lbf`.
    fn ratio(&mut self, form: FrfForm, unit: Unit, force_label: Label) -> Result<Ordinate, UnitsError> {
        if let Label::Unit(force) = force_label
            && force.dimension != self.force()
        {
            // The error of a force that is none.
            self.force_factor(force_label)?;
        }
        let label = self.numerator.units.trim().to_owned();
        let by_system = self
            .system_factor(&axis_of(form), self.response)
            .zip(self.system_factor(&Axis::excitation_force(), self.reference))
            .map(|(motion, force)| motion / force);
        if disagree(Some(unit.si), by_system) {
            return self.ratio_as_assumed(form, label);
        }
        if unit.si != 1.0 {
            self.notes.insert(format!("FRFs in `{label}` were converted to SI"));
        }
        Ok(Ordinate { form, si: unit.si })
    }

    /// The analyst's word on a ratio whose label disagrees with the file's unit system.
    fn ratio_as_assumed(&mut self, form: FrfForm, label: String) -> Result<Ordinate, UnitsError> {
        let rotational = self.response.is_rotational() || self.reference.is_rotational();
        let Some(assumed) = self.assumed.filter(|assumed| assumed.form == form && !rotational) else {
            let system = self.system.map_or("", |units| units.description.trim()).to_owned();
            return Err(UnitsError::System { axis: "response", label, system });
        };
        self.notes.insert_assumed(format!(
            "FRFs in `{label}`: label and dataset 164 disagree, `{}` per `{}` taken as `--assume-units` says",
            assumed.response.text, assumed.force.text
        ));
        Ok(Ordinate { form, si: assumed.response.si / assumed.force.si })
    }

    /// SI units in one of the unit system in force, if there is any.
    fn system_factor(&self, axis: &Axis, channel: FileChannel) -> Option<f64> {
        self.system.map(|units| units.si_per_unit(exponents(axis, channel)))
    }
}

/// Whether the data type leaves open what the axis is.
fn open(axis: &Axis) -> bool {
    matches!(axis.data_type, data_type::UNKNOWN | data_type::GENERAL)
}

/// The numerator's axis in SI.
fn axis_of(form: FrfForm) -> Axis {
    match form {
        FrfForm::Receptance => Axis::displacement(),
        FrfForm::Mobility => Axis::velocity(),
        FrfForm::Accelerance => Axis::acceleration(),
    }
}

fn disagree(by_label: Option<f64>, by_system: Option<f64>) -> bool {
    matches!((by_label, by_system), (Some(l), Some(s)) if !agree(l, s))
}

/// Unit exponents of a quantity in a channel's direction; a scalar one counts as a translation.
fn exponents(axis: &Axis, channel: FileChannel) -> [i32; 3] {
    axis.unit_exponents(if channel.direction == 0 { 2 } else { channel.direction })
}
