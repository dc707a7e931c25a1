//! Renders a page of comparisons as HTML.

use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, Value, context};

use super::Entry;
use crate::golden::measures::Measures;
use crate::plural::count;

fn numbers(measures: &Measures) -> Vec<(&'static str, String)> {
    let Measures { compared, masked, difference, pixels_over, mean, psnr, ssim, flip } = measures;
    let whole = |pixels: usize| count(pixels as u64);
    let mut numbers = vec![
        ("pixels that differ", format!("{} of {}", whole(difference.pixels), whole(*compared))),
        ("pixels over the tolerance", whole(*pixels_over)),
    ];
    numbers.extend((*masked > 0).then(|| ("masked pixels", whole(*masked))));
    let four = |x: f64| format!("{x:.4}");
    let mut add = |name, x: f64, said: String| numbers.extend(x.is_finite().then_some((name, said)));
    add("largest difference", difference.largest, format!("{} of {}", difference.largest, difference.full_scale));
    add("mean difference", *mean, four(*mean));
    add("PSNR", *psnr, format!("{psnr:.2} dB"));
    ssim.iter().for_each(|&ssim| add("SSIM", ssim, format!("{ssim:.5}")));
    if let Some(flip) = flip {
        add("FLIP, mean", flip.mean, four(flip.mean));
        add("FLIP, 95th percentile", flip.percentile_95, four(flip.percentile_95));
        add("FLIP, largest", flip.largest, four(flip.largest));
    }
    numbers
}

fn value(entry: Entry) -> Value {
    let numbers = entry.comparison.measures.as_ref().map(numbers).unwrap_or_default();
    context! { numbers => numbers, ..Value::from(Serde(entry)) }
}

pub fn page(title: &str, mut entries: Vec<Entry>) -> String {
    entries.sort_by_key(|entry| (entry.comparison.verdict, entry.number));
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_template("page.html", include_str!("page.html")).expect(RENDERED);
    let template = environment.get_template("page.html").expect(RENDERED);
    let failing = entries.iter().filter(|entry| entry.fails).count();
    let page = context! {
        title => title,
        failing => failing,
        entries => entries.into_iter().map(value).collect::<Vec<Value>>(),
        css => include_str!("page.css"),
        js => include_str!("page.js"),
        version => env!("CARGO_PKG_VERSION"),
    };
    template.render(page).expect(RENDERED)
}

const RENDERED: &str = "a test renders the template with all kinds of comparisons";
