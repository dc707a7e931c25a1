//! Tables as CSV: one number per field, without units; the ends of an interval have separate columns.

use super::{Cell, Table, Value};

/// The table under a row of names. A column `x` with intervals becomes `x`, `x_low` and `x_high`, a column with errors
/// `x` and `x_of`. An unknown value is empty.
pub fn table(table: &Table) -> Vec<u8> {
    let column = |i: usize| table.rows.iter().map(move |row| &row[i].value);
    let has = |is: fn(&Value) -> bool| (0..table.columns.len()).map(|i| column(i).any(is)).collect::<Vec<bool>>();
    let has_interval = has(|value| matches!(value, Value::Estimate(..)));
    let has_errors = has(|value| matches!(value, Value::Errors { .. }));
    let mut writer = csv::Writer::from_writer(vec![]);
    let mut names = vec![];
    for (i, name) in table.columns.iter().enumerate() {
        names.push(name.clone());
        names.extend(["_low", "_high"].iter().filter(|_| has_interval[i]).map(|end| format!("{name}{end}")));
        names.extend(has_errors[i].then(|| format!("{name}_of")));
    }
    if !names.is_empty() {
        writer.write_record(&names).expect("memory takes every write");
    }
    for row in &table.rows {
        let mut fields = vec![];
        for (i, cell) in row.iter().enumerate() {
            let [own, low, high, of] = parts(cell);
            fields.push(own);
            fields.extend([low, high].into_iter().filter(|_| has_interval[i]));
            fields.extend(Some(of).filter(|_| has_errors[i]));
        }
        writer.write_record(&fields).expect("all rows have the same columns");
    }
    writer.into_inner().expect("memory takes every write")
}

/// The value, the ends of its interval, and the number of checked rays.
fn parts(cell: &Cell) -> [String; 4] {
    let mut parts = <[String; 4]>::default();
    parts[0] = match &cell.value {
        Value::Empty => String::new(),
        Value::Text(text) => text.clone(),
        Value::Count(n) => n.to_string(),
        Value::Difference(n) => n.to_string(),
        Value::Number(x, _) => x.to_string(),
        Value::Estimate(x, _) => {
            let [low, high] = [x.low(), x.high()].map(|end| end.map_or(String::new(), |end| end.to_string()));
            [parts[1], parts[2]] = [low, high];
            x.estimate.to_string()
        }
        Value::Errors { wrong, of } => {
            parts[3] = of.to_string();
            wrong.to_string()
        }
    };
    parts
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
