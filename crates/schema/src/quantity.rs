//! Numbers with how well they are known.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};
use std::borrow::Cow;

/// The schema of a quantity whose value satisfies `range`.
pub(crate) fn of(range: &Value) -> Value {
    let mut number = json!({ "type": "number" });
    if let (Some(number), Some(range)) = (number.as_object_mut(), range.as_object()) {
        number.extend(range.clone());
    }
    json!({
        "anyOf": [
            number,
            {
                "type": "object",
                "description": "A number with one standard deviation, in the number's own unit.",
                "properties": {
                    "value": number,
                    "std": {
                        "description": "One standard deviation, in the unit of the value; \"unknown\" leaves the value free in a fit.",
                        "anyOf": [{ "type": "number", "minimum": 0 }, { "const": "unknown" }]
                    }
                },
                "required": ["value", "std"],
                "additionalProperties": false
            }
        ]
    })
}

/// A type by whose name a quantity's range goes.
macro_rules! quantity {
    ($name:ident, $description:literal, $range:tt) => {
        #[doc = $description]
        pub(crate) struct $name;

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                let mut schema = json_schema!({ "description": $description });
                let of = of(&json!($range));
                schema.insert("anyOf".into(), of["anyOf"].clone());
                schema
            }
        }
    };
}

quantity!(
    Quantity,
    "A number, or a number with one standard deviation: 1.2 or {\"value\": 1.2, \"std\": 0.01}. A bare number has the default deviation of its kind.",
    {}
);
quantity!(Positive, "A quantity above zero: 1.2 or {\"value\": 1.2, \"std\": 0.01}.", { "exclusiveMinimum": 0 });
quantity!(NotNegative, "A quantity of zero or above: 1.2 or {\"value\": 1.2, \"std\": 0.01}.", { "minimum": 0 });
quantity!(
    Ratio,
    "A damping ratio from 0 to below 1: 1 % of critical is 0.01.",
    { "minimum": 0, "exclusiveMaximum": 1 }
);
quantity!(PoissonRatio, "Between -1 and 0.5.", { "exclusiveMinimum": -1, "exclusiveMaximum": 0.5 });
