//! Records as JSON and CSV.

use serde::Serialize;
use serde_json::Value;

use super::Record;
use super::words::each_once;
use crate::measure::Provenance;

/// What a study exports: its result, and where it comes from.
#[derive(Clone, Debug, Serialize)]
pub struct Export<'a, R> {
    /// Version of this form.
    pub schema: u32,
    /// Name of the study.
    pub study: &'a str,
    /// Of the run that measured, which is an older one where a journal is shown again.
    pub provenance: &'a Provenance,
    pub result: R,
}

impl<'a, R> Export<'a, R> {
    /// Version of this form.
    pub const SCHEMA: u32 = 1;

    pub fn new(study: &'a str, provenance: &'a Provenance, result: R) -> Self {
        Self { schema: Self::SCHEMA, study, provenance, result }
    }
}

impl<R: Serialize> Export<'_, &[R]> {
    /// As [`to_tidy_csv`], one row for each of the result; every row begins with `schema` and `study` and ends with the columns
    /// `provenance.*`.
    pub fn to_csv(&self) -> Vec<u8> {
        let row = |own: &R| serde_json::json!({ "schema": self.schema, "study": self.study, "own": own, "provenance": self.provenance });
        to_tidy_csv(&self.result.iter().map(row).map(|row| inlined(row, "own")).collect::<Vec<Value>>())
    }
}

/// The map `row` with the fields of its map `name` in the place of that.
fn inlined(row: Value, name: &str) -> Value {
    let Value::Object(fields) = row else { return row };
    let mut all = serde_json::Map::new();
    for (key, value) in fields {
        match value {
            Value::Object(inner) if key == name => all.extend(inner),
            value => drop(all.insert(key, value)),
        }
    }
    Value::Object(all)
}

/// Anything as indented JSON with a final newline.
pub fn to_json(value: &impl Serialize) -> Vec<u8> {
    let mut bytes = serde_json::to_vec_pretty(value).expect("records have text keys and finite numbers");
    bytes.push(b'\n');
    bytes
}

/// As [`to_tidy_csv`], but for the configurations, whose keys differ: they are JSON text.
pub fn to_csv(records: &[Record]) -> Vec<u8> {
    let row = |record: &Record| {
        let mut row = serde_json::to_value(record).expect("records have text keys and finite numbers");
        row["config"] = row["config"].to_string().into();
        row
    };
    to_tidy_csv(&records.iter().map(row).collect::<Vec<Value>>())
}

/// One record per line.
pub fn to_jsonl<T: Serialize>(records: &[T]) -> Vec<u8> {
    let line = |record| serde_json::to_string(record).expect("records have text keys and finite numbers") + "\n";
    records.iter().map(line).collect::<String>().into_bytes()
}

/// One row for each of `rows` under a row of names; a field within a field is called `outer.inner`, and what a row does not
/// have is blank.
pub fn to_tidy_csv(rows: &[impl Serialize]) -> Vec<u8> {
    let flat = |row| {
        let mut fields = vec![];
        flatten("", serde_json::to_value(row).expect("a row has text keys"), &mut fields);
        fields
    };
    let rows: Vec<Vec<(String, String)>> = rows.iter().map(flat).collect();
    let names = each_once(rows.iter().flatten().map(|(name, _)| name.as_str()));
    // A field that is unknown in one row and has fields of its own in another is those fields.
    let has_fields =
        |name: &str| names.iter().any(|other| other.strip_prefix(name).is_some_and(|rest| rest.starts_with('.')));
    let names: Vec<&str> = names.iter().copied().filter(|name| !has_fields(name)).collect();
    let mut writer = csv::Writer::from_writer(vec![]);
    if !names.is_empty() {
        writer.write_record(&names).expect("memory takes every write");
    }
    for row in &rows {
        let cell = |name: &&str| row.iter().find(|(own, _)| own == name).map_or("", |(_, value)| value);
        writer.write_record(names.iter().map(cell)).expect("all rows have the same columns");
    }
    writer.into_inner().expect("memory takes every write")
}

/// Name and text of every field of `value`, those within maps as well.
fn flatten(name: &str, value: Value, fields: &mut Vec<(String, String)>) {
    match value {
        Value::Object(inner) => {
            let dot = if name.is_empty() { "" } else { "." };
            inner.into_iter().for_each(|(key, value)| flatten(&format!("{name}{dot}{key}"), value, fields));
        }
        value => fields.push((name.into(), text(value))),
    }
}

fn text(value: Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text,
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::record::example;
    use super::*;

    #[test]
    fn an_export_says_in_every_row_where_it_comes_from() {
        let provenance = Provenance::capture(1);
        let rows =
            [serde_json::json!({ "scene": "Cube", "time": { "low": 1.0 } }), serde_json::json!({ "scene": "A,B" })];
        let export = Export::new("scaling", &provenance, &rows[..]);
        let csv = String::from_utf8(export.to_csv()).unwrap();
        let mut lines = csv.lines();
        let names: Vec<&str> = lines.next().unwrap().split(',').collect();
        assert_eq!(names[..4], ["schema", "study", "scene", "time.low"]);
        for name in ["provenance.command", "provenance.commit", "provenance.build", "provenance.date"] {
            assert!(names.contains(&name), "{name} is not in {names:?}");
        }
        assert!(lines.all(|line| line.starts_with("1,scaling,") && line.contains(&provenance.date)), "{csv}");
        let json: Value = serde_json::from_slice(&to_json(&export)).unwrap();
        assert_eq!((&json["schema"], &json["result"][0]["scene"]), (&1.into(), &"Cube".into()));
        assert_eq!(json["provenance"]["date"], provenance.date);
    }

    #[test]
    fn json_is_an_array_of_records() {
        let records = vec![example(), example()];
        let bytes = to_json(&records);
        assert!(bytes.ends_with(b"]\n"));
        assert_eq!(serde_json::from_slice::<Vec<Record>>(&bytes).unwrap(), records);
    }

    #[test]
    fn csv_has_a_column_for_every_field_and_blanks_for_what_is_unknown() {
        let bytes = to_csv(&[example(), example()]);
        let mut reader = csv::Reader::from_reader(&bytes[..]);
        let names = reader.headers().unwrap().clone();
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 2);
        let cell = |name: &str| rows[1][names.iter().position(|n| n == name).unwrap()].to_owned();
        assert_eq!(cell("scene"), "Cube");
        assert_eq!(cell("tests_per_ray"), "");
        assert_eq!(cell("steps_per_ray"), "1.5");
        assert_eq!(cell("config"), r#"{"leaf":8,"threshold":0.7}"#);
        assert_eq!(cell("provenance.threads"), "1");
        assert_eq!((cell("counts.leaves"), cell("counts.sah_cost")), ("7".into(), String::new()));
    }

    #[test]
    fn tidy_rows_name_inner_fields_by_a_path() {
        let row = |speed: Option<f64>| serde_json::json!({ "scene": "Cube", "speed": { "low": 1.5, "high": speed } });
        let text = String::from_utf8(to_tidy_csv(&[row(Some(2.0)), row(None)])).unwrap();
        assert_eq!(text, "scene,speed.low,speed.high\nCube,1.5,2.0\nCube,1.5,\n");
    }

    #[test]
    fn nothing_exports_as_nothing() {
        assert_eq!(to_json(&Vec::<Record>::new()), b"[]\n");
        assert!(to_csv(&Vec::<Record>::new()).is_empty());
    }
}
