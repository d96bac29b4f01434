//! Effects, read off the table that the reader uses.

use crate::quantity;
use jointscope_fixture::{EffectKind, EffectSpec, Motion, ParameterRange, PlaceKind};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};
use std::borrow::Cow;

/// One effect beyond the plain model.
pub(crate) struct Effect;

impl JsonSchema for Effect {
    fn schema_name() -> Cow<'static, str> {
        "Effect".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let kinds: Vec<Value> = EffectKind::ALL.iter().map(|kind| of_kind(kind.spec())).collect();
        json_schema!({
            "description": "An effect beyond the plain model: what a diagnosis finds, and what may be stated. A bare parameter is exact.",
            "oneOf": kinds
        })
    }
}

fn of_kind(spec: &EffectSpec) -> Value {
    let mut properties = Map::new();
    let mut required = vec!["kind", "place"];
    properties.insert("kind".into(), json!({ "const": spec.name }));
    properties.insert("place".into(), place(spec.place));
    if spec.has_dof || spec.may_turn {
        let description = match spec.has_dof {
            true => "In which motion it acts.",
            false => {
                "In which motion it acts; translation where nothing is said. In rotation it has no abscissa."
            }
        };
        properties
            .insert("dof".into(), json!({ "enum": ["translation", "rotation"], "description": description }));
    }
    if spec.has_dof {
        required.push("dof");
    }
    for parameter in spec.parameters {
        let range = match parameter.range {
            ParameterRange::Any => json!({}),
            ParameterRange::Positive => json!({ "exclusiveMinimum": 0 }),
            ParameterRange::NonNegative => json!({ "minimum": 0 }),
            ParameterRange::NonZero => json!({ "not": { "const": 0 } }),
        };
        let mut schema = quantity::of(&range);
        let unit = match parameter.unit {
            "" => "A pure number, or in the unit of what it is about.".to_owned(),
            unit => format!("In {unit}."),
        };
        schema["description"] = match parameter.default {
            Some(default) => json!(format!("{unit} {default} where it is left out.")),
            None => json!(unit),
        };
        properties.insert(parameter.name.into(), schema);
        // In rotation an effect on a whole body sits at no abscissa.
        let may_miss = spec.may_turn && matches!(parameter.motion, Motion::AlongBody);
        if parameter.default.is_none() && !may_miss {
            required.push(parameter.name);
        }
    }
    let mut schema = json!({
        "title": spec.name,
        "description": sentence(spec),
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false
    });
    let abscissa = spec.parameters.iter().find(|parameter| matches!(parameter.motion, Motion::AlongBody));
    if let (true, Some(abscissa)) = (spec.may_turn, abscissa) {
        schema["if"] = json!({ "properties": { "dof": { "const": "rotation" } }, "required": ["dof"] });
        schema["else"] = json!({ "required": [abscissa.name] });
    }
    schema
}

/// What a diagnosis says of such an effect, its parameters by their names.
fn sentence(spec: &EffectSpec) -> String {
    let said = spec.words.otherwise.replace(['[', ']'], "").replace(['{', '}'], "`");
    format!("As a diagnosis says it: {said}.")
}

fn place(kind: PlaceKind) -> Value {
    let text = |description: &str| json!({ "type": "string", "description": description });
    match kind {
        PlaceKind::Body => text("The name of a body."),
        PlaceKind::Point => text("The name of a point."),
        PlaceKind::PointOrChannel => text(
            "The name of a point, `3`: sensor and impacts alike; `response 3` for its sensor, `reference 3` for its impacts alone.",
        ),
        PlaceKind::Joint => text("The name of a joint."),
        PlaceKind::JointOrBeamBody => text("The name of a joint, or of a body that is a beam."),
        PlaceKind::Beam => text("The name of a joint that is a beam, or of a body that is one."),
        PlaceKind::TwoBodies => {
            json!({ "type": "string", "pattern": "^.+/.+$", "description": "Two bodies, such as A/B." })
        }
        PlaceKind::Channel => json!({
            "type": "string", "pattern": "^(response .+|reference .+|record .+/.+|force|responses)$", "description": "`response N`, `reference N` (N a point, `N:theta` for a rotation), `record N/M` (the record of one FRF), `force`, or `responses` (all of them alike)."
        }),
        PlaceKind::ResponseChannel => {
            json!({ "type": "string", "pattern": "^(response .+|responses)$", "description": "`response N`, N a point, or `responses`: one sensor that is moved from point to point." })
        }
        PlaceKind::All => json!({ "const": "all" }),
        _ => text("The path of a quantity in this file, such as `bodies/A/mass`."),
    }
}
