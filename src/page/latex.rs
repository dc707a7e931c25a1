//! The report as LaTeX: tables with booktabs, figures as pictures beside it.

use crate::report::document::{Art, Block, Document, Figure};
use crate::report::words::ended;
use crate::report::{Table, Tone};

const HEAD: &str = r"\documentclass[a4paper]{article}
\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage[margin=22mm]{geometry}
\usepackage{booktabs,caption,graphicx,textcomp}
\setlength{\parindent}{0pt}
\setlength{\parskip}{6pt}
\begin{document}
";

/// The text of the file.
pub fn latex(document: &Document) -> String {
    let mut text = HEAD.to_owned();
    text += &format!("\\section*{{{}}}\n", escaped(&document.title));
    if !document.answer.banner.is_empty() {
        text += &format!("\\fbox{{\\parbox{{0.95\\textwidth}}{{{}}}}}\n\n", escaped(&document.answer.banner));
    }
    text += &format!("\\textbf{{{}.}}\n\n", escaped(&document.answer.verdict));
    for number in &document.answer.numbers {
        let words = [&number.label, &number.number, &number.interval].map(|words| escaped(words));
        text += &format!("{}: \\textbf{{{}}} {}\\\\\n", words[0], words[1], words[2]);
    }
    for sentence in &document.answer.sentences {
        text += &format!("\n{}\n", escaped(sentence));
    }
    for section in &document.sections {
        text += &format!("\n\\section*{{{}}}\n\n", escaped(section.title));
        blocks(&section.blocks, &mut text);
    }
    text + "\\end{document}\n"
}

fn blocks(list: &[Block], text: &mut String) {
    for block in list {
        match block {
            Block::Text(words) | Block::Note(words) => *text += &format!("{}\n\n", escaped(words)),
            Block::Table(tabular) => *text += &table(&tabular.table),
            Block::Figure(f) => figure(f, text),
            Block::Missing(missing) => {
                let [what, command] = [&ended(&missing.what), &missing.command].map(|words| escaped(words));
                *text += &format!("Not measured: {what} \\texttt{{{command}}} measures it.\n\n");
            }
            Block::Fold(name, inner) => {
                *text += &format!("\\subsection*{{{}}}\n\n", escaped(name));
                blocks(inner, text);
            }
        }
    }
}

/// More columns than this are shrunk to the width of the page.
const COLUMNS: usize = 5;

fn table(table: &Table) -> String {
    let line = |cells: Vec<String>| format!("{} \\\\\n", cells.join(" & "));
    let mut rows = line(table.columns.iter().map(|name| escaped(name)).collect());
    rows += "\\midrule\n";
    for row in &table.rows {
        let cell = |cell: &crate::report::Cell| match cell.tone {
            Tone::Plain => escaped(&cell.text),
            Tone::Best | Tone::Wrong => format!("\\textbf{{{}}}", escaped(&cell.text)),
        };
        rows += &line(row.iter().map(cell).collect());
    }
    let places = "r".repeat(table.columns.len().saturating_sub(1));
    let tabular = format!("\\begin{{tabular}}{{l{places}}}\n\\toprule\n{rows}\\bottomrule\n\\end{{tabular}}");
    let is_wide = table.columns.len() > COLUMNS
        || table.rows.iter().any(|row| row.iter().map(|cell| cell.text.chars().count() + 2).sum::<usize>() > 85);
    let tabular = if is_wide { format!("\\resizebox{{\\linewidth}}{{!}}{{%\n{tabular}}}") } else { tabular };
    let notes: String = table.notes.iter().map(|note| format!("{{\\footnotesize {}\\par}}\n", escaped(note))).collect();
    let title = escaped(&table.title);
    format!("\\begin{{center}}\n\\captionof{{table}}{{{title}}}\n{tabular}\n\\end{{center}}\n{notes}\n")
}

fn figure(figure: &Figure, text: &mut String) {
    let one = |i| format!("\\includegraphics[width=0.24\\linewidth]{{{}}}\n", figure.picture_path(i));
    let pictures: String = match &figure.art {
        Art::Chart(_) => format!("\\includegraphics[width=\\linewidth]{{figures/{}.png}}\n", figure.id),
        Art::Gallery(_) | Art::Overlay(_) => (0..figure.pictures().len()).map(one).collect(),
    };
    let caption = escaped(&figure.caption);
    *text += &format!("\\begin{{center}}\n{pictures}\\captionof{{figure}}{{{caption}}}\n\\end{{center}}\n\n");
}

/// Text that LaTeX would read as commands, and what the usual fonts lack.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => {
                out.push('\\');
                out.push(c);
            }
            '\\' => out.push_str("\\textbackslash{}"),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '<' => out.push_str("\\textless{}"),
            '>' => out.push_str("\\textgreater{}"),
            '|' => out.push_str("\\textbar{}"),
            '"' => out.push_str("\\textquotedbl{}"),
            '×' => out.push_str("\\ensuremath{\\times}"),
            '·' => out.push_str("\\ensuremath{\\cdot}"),
            '−' => out.push_str("\\ensuremath{-}"),
            '≤' => out.push_str("\\ensuremath{\\le}"),
            '≥' => out.push_str("\\ensuremath{\\ge}"),
            '\n' | '\r' | '\t' => out.push(' '),
            // What is in no font of the first page of Latin stops the run: a question mark does not.
            c if c.is_control() || c as u32 > 0x17F => out.push('?'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_latex_reads_as_commands_is_escaped() {
        assert_eq!(escaped("a_b & 5% #1 {x}"), "a\\_b \\& 5\\% \\#1 \\{x\\}");
        assert_eq!(escaped("\\input{x}^~"), "\\textbackslash{}input\\{x\\}\\textasciicircum{}\\textasciitilde{}");
        assert_eq!(escaped("Möller × 日"), "Möller \\ensuremath{\\times} ?");
    }

    #[test]
    fn a_table_has_as_many_columns_as_cells() {
        let text = table(&Table::of_texts("T_1", ["a&b", "c"], vec![["x".into(), "1".into()]]));
        assert!(
            text.contains("\\begin{tabular}{lr}\n\\toprule\na\\&b & c \\\\\n\\midrule\nx & 1 \\\\\n\\bottomrule"),
            "{text}"
        );
        assert!(text.contains("\\captionof{table}{T\\_1}"), "{text}");
        assert!(!text.contains("resizebox"), "{text}");
        let wide = table(&Table::of_texts("", ["a", "b", "c", "d", "e", "f"], vec![]));
        assert!(wide.contains("\\resizebox{\\linewidth}{!}{%\n\\begin{tabular}{lrrrrr}"), "{wide}");
    }
}
