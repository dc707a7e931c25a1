//! Writes tables as CSV, without units.

use super::{Cell, Table, Value};

/// Name suffixes for the value, both interval ends and the number of checked rays.
const ENDINGS: [&str; 4] = ["", "_low", "_high", "_of"];

pub fn table(table: &Table) -> Vec<u8> {
    let fields_of = |i: usize| {
        let has = |is: fn(&Value) -> bool| table.rows.iter().any(|row| is(&row[i].value));
        let has_interval = has(|value| matches!(value, Value::Estimate(..)));
        [true, has_interval, has_interval, has(|value| matches!(value, Value::Errors { .. }))]
    };
    let columns: Vec<[bool; 4]> = (0..table.columns.len()).map(fields_of).collect();
    let kept = |fields: [String; 4], column: [bool; 4]| {
        fields.into_iter().zip(column).filter(|(_, is_kept)| *is_kept).map(|(field, _)| field)
    };
    let mut writer = csv::Writer::from_writer(vec![]);
    if !columns.is_empty() {
        let names = |name: &String| ENDINGS.map(|ending| format!("{name}{ending}"));
        let names = table.columns.iter().zip(&columns).flat_map(|(name, column)| kept(names(name), *column));
        writer.write_record(names.collect::<Vec<_>>()).expect("writing to memory cannot fail");
    }
    for row in &table.rows {
        let fields = row.iter().zip(&columns).flat_map(|(cell, column)| kept(fields(cell), *column));
        writer.write_record(fields.collect::<Vec<_>>()).expect("all rows have the same columns");
    }
    writer.into_inner().expect("writing to memory cannot fail")
}

fn fields(cell: &Cell) -> [String; 4] {
    let none = String::new;
    match &cell.value {
        Value::Empty => Default::default(),
        Value::Text(text) => [text.clone(), none(), none(), none()],
        Value::Count(n) => [n.to_string(), none(), none(), none()],
        Value::Difference(n) => [n.to_string(), none(), none(), none()],
        Value::Number(x, _) => [x.to_string(), none(), none(), none()],
        Value::Estimate(x, _) => {
            let [low, high] = [x.low(), x.high()].map(|end| end.map_or(none(), |end| end.to_string()));
            [x.estimate.to_string(), low, high, none()]
        }
        Value::Errors { wrong, of } => [wrong.to_string(), none(), none(), of.to_string()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Estimate;

    #[test]
    fn intervals_have_columns_of_their_own_and_numbers_no_units() {
        let rows = [
            vec![Cell::from("A,B"), Cell::from(Estimate::between(2.0, 1.5, 2.5)), Cell::bytes(1536)],
            vec![Cell::from("C"), Cell::from(Estimate::alone(3.0)), Cell::empty()],
        ];
        let text = String::from_utf8(table(&Table::new("", ["scene", "speed", "bytes"], rows))).unwrap();
        assert_eq!(text, "scene,speed,speed_low,speed_high,bytes\n\"A,B\",2,1.5,2.5,1536\nC,3,,,\n");
        let rows = [vec![Cell::from("C"), Value::Errors { wrong: 1, of: 9 }.into()]];
        let text = String::from_utf8(table(&Table::new("", ["scene", "errors"], rows))).unwrap();
        assert_eq!(text, "scene,errors,errors_of\nC,1,9\n");
        assert!(table(&Table::default()).is_empty());
    }
}
