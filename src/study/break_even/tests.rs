use super::result::best;
use super::*;
use crate::measure::{Part, RandomOrder};
use crate::study::epoch::tests::example;

/// Three epochs; 1000 rays a sample, so that a sample of 1000 n nanoseconds is n a ray.
fn epochs(structures: &[(&str, u64, u64)]) -> Vec<Epoch> {
    let wobble = [[100u64, 101, 99], [103, 102, 104], [98, 97, 99]];
    wobble
        .iter()
        .enumerate()
        .map(|(epoch, wobble)| {
            let samples: Vec<[u64; 3]> =
                structures.iter().map(|(_, _, ns)| wobble.map(|share| ns * 1000 * share / 100)).collect();
            let structures: Vec<(&str, u64, &[u64])> = structures
                .iter()
                .zip(&samples)
                .map(|((label, build, _), samples)| (*label, build * wobble[0] / 100, &samples[..]))
                .collect();
            example("a", 10, epoch, &structures)
        })
        .collect()
}

fn pair<'a>(market: &'a Market, cheap: &str, dear: &str) -> &'a Pair {
    market.pairs.iter().find(|pair| pair.cheap == cheap && pair.dear == dear).unwrap()
}

#[test]
fn pairs_break_even_where_arithmetic_says() {
    // Build and time of a ray: slow over quick pays after 9,000 / 90 rays.
    let markets = result(&epochs(&[("slow", 1000, 100), ("dear", 50_000, 20), ("quick", 10_000, 10)]));
    let [market] = &markets[..] else { panic!("{markets:?}") };
    let of = pair(market, "slow", "quick");
    let Payoff::Rays(rays) = of.rays else { panic!("{of:?}") };
    assert!((rays / 100.0 - 1.0).abs() < 0.01, "{rays}");
    let (Some(Payoff::Rays(low)), Some(Payoff::Rays(high))) = (of.low, of.high) else { panic!("{of:?}") };
    assert!(low <= rays && rays <= high && high / low < 1.5, "{of:?}");
    // Dearer and slower.
    let of = pair(market, "quick", "dear");
    assert_eq!((of.rays, of.low, of.high), (Payoff::Never, Some(Payoff::Never), Some(Payoff::Never)));
    assert_eq!(BreakEvenStudy::tables(&markets).len(), 1);
    assert_eq!(rows(&markets).len(), 3);
}

#[test]
fn what_is_timed_on_few_rays_changes_no_pair_but_its_own() {
    let structures = [("slow", 1000, 100), ("quick", 10_000, 10)];
    let alone = result(&epochs(&structures));
    let mut epochs = epochs(&[structures[0], structures[1], ("brute", 1, 1000)]);
    // It is timed on ten rays, on which the others take three times as long.
    for structure in epochs.iter_mut().flat_map(|epoch| &mut epoch.structures) {
        let rays = &mut structure.rays[0];
        let of_ten = |times: u64| -> Vec<u64> { rays.ns.iter().map(|ns| ns * times / 100).collect() };
        if structure.label == "brute" {
            (rays.rays, rays.ns) = (10, of_ten(1));
        } else {
            rays.parts = vec![Part { rays: 10, ns: of_ten(3) }];
        }
    }
    let markets = result(&epochs);
    assert_eq!(pair(&markets[0], "slow", "quick"), pair(&alone[0], "slow", "quick"));
    assert!(alone[0].offers.iter().all(|offer| markets[0].offers.contains(offer)), "{markets:?}");
    // 9,999 nanoseconds of a build, and 1000 - 30 of a ray.
    let of = pair(&markets[0], "brute", "quick");
    assert!(matches!(of.rays, Payoff::Rays(rays) if (rays / 10.3 - 1.0).abs() < 0.02), "{of:?}");
    // In the end rays alone count: 1000 over 30 nanoseconds, not over the 10 of all rays.
    let slowdowns = ["brute", "slow", "quick"].map(|structure| markets[0].slowdown(structure, 1e12));
    for (slowdown, expected) in slowdowns.into_iter().zip([1000.0 / 30.0, 10.0, 1.0]) {
        assert!((slowdown / expected - 1.0).abs() < 0.02, "{slowdowns:?}");
    }
}

#[test]
fn what_noise_cannot_tell_apart_may_never_pay() {
    // Half a per cent faster, and the epochs differ by three, not all in step.
    let mut epochs = epochs(&[("cheap", 1000, 1000), ("dear", 2000, 995)]);
    epochs[1].structures[1].rays[0].ns.iter_mut().for_each(|ns| *ns = *ns * 103 / 100);
    epochs[2].structures[1].rays[0].ns.iter_mut().for_each(|ns| *ns = *ns * 97 / 100);
    let markets = result(&epochs);
    let of = pair(&markets[0], "cheap", "dear");
    assert!(matches!(of.rays, Payoff::Rays(_)) && of.high == Some(Payoff::Never), "{of:?}");
}

#[test]
fn the_best_changes_only_where_it_is_overtaken() {
    // The second is beaten by the third before it has beaten the first.
    let offers = [("a", (0.0, 10.0)), ("b", (90.0, 9.0)), ("c", (100.0, 5.0)), ("d", (1000.0, 4.0))];
    let mut pairs = vec![];
    for (i, &(dear, costs)) in offers.iter().enumerate() {
        pairs.extend(offers[..i].iter().map(|&(cheap, own)| Pair {
            cheap: cheap.into(),
            dear: dear.into(),
            costs: [own, costs],
            rays: Payoff::of(own, costs),
            low: None,
            high: None,
        }));
    }
    let best = best("a", &pairs);
    let of: Vec<(&str, f64)> = best.iter().map(|stretch| (stretch.structure.as_str(), stretch.from)).collect();
    assert_eq!(of, [("a", 0.0), ("c", 20.0), ("d", 900.0)]);
}

#[test]
fn of_one_epoch_there_is_no_interval() {
    let mut epochs = epochs(&[("slow", 1000, 100), ("quick", 10_000, 10)]);
    epochs.truncate(1);
    let markets = result(&epochs);
    assert_eq!((markets[0].pairs[0].low, markets[0].pairs[0].high), (None, None));
    let table = &table(&markets[0]);
    assert!(table.rows[1][3].text.ends_with("(one epoch)"), "{table:?}");
    assert!(table.notes.iter().any(|note| note.contains("one epoch, no interval")));
}

/// Epochs in which builds and rays vary with this standard deviation of their logarithms.
fn run(random: &mut RandomOrder, sigma: f64) -> Vec<Epoch> {
    let epoch = |e: usize| {
        let mut vary = |ns: f64| (ns * libm::exp(sigma * random.normal())) as u64;
        let ns = [vary(1e8), vary(8e7)].map(|ns| [ns]);
        let structures: [(&str, u64, &[u64]); 2] = [("cheap", vary(1e9), &ns[0]), ("dear", vary(5e9), &ns[1])];
        example("a", 10, e, &structures)
    };
    (0..5).map(epoch).collect()
}

#[test]
fn the_break_even_point_of_a_second_run_lies_within_the_interval_of_the_first() {
    const PAIRS: u64 = 1000;
    // Rays differ by a fifth. With a twentieth of noise some runs find that the dear one never pays.
    for sigma in [0.005, 0.05, 0.15] {
        let once = |seed: &u64| {
            let mut random = RandomOrder::new(*seed);
            let [first, second] = [(); 2].map(|()| pair(&result(&run(&mut random, sigma))[0], "cheap", "dear").clone());
            let (low, high) = (first.low.unwrap(), first.high.unwrap());
            low <= second.rays && second.rays <= high
        };
        let held = (0..PAIRS).filter(once).count() as f64 * 100.0 / PAIRS as f64;
        assert!((93.0..=97.0).contains(&held), "{held:.1} % with noise of {sigma}");
    }
}
