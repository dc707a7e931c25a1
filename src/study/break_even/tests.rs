use super::*;
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
    let markets = result(&epochs(&[("slow", 1000, 100), ("dear", 50_000, 20), ("quick", 10_000, 10)]), 1);
    let [market] = &markets[..] else { panic!("{markets:?}") };
    let of = pair(market, "slow", "quick");
    let Payoff::Rays(rays) = of.rays else { panic!("{of:?}") };
    assert!((rays / 100.0 - 1.0).abs() < 0.01, "{rays}");
    let (Payoff::Rays(low), Payoff::Rays(high)) = (of.low, of.high) else { panic!("{of:?}") };
    assert!(low < rays && rays < high && high / low < 1.5, "{of:?}");
    // Dearer and slower.
    let of = pair(market, "quick", "dear");
    assert_eq!((of.rays, of.low, of.high), (Payoff::Never, Payoff::Never, Payoff::Never));
    assert_eq!(tables(&markets).len(), 1);
    assert_eq!(rows(&markets).len(), 3);
}

#[test]
fn what_noise_cannot_tell_apart_may_never_pay() {
    // Half a per cent faster, and the epochs differ by three, not all in step.
    let mut epochs = epochs(&[("cheap", 1000, 1000), ("dear", 2000, 995)]);
    epochs[1].structures[1].rays[0].ns.iter_mut().for_each(|ns| *ns = *ns * 103 / 100);
    epochs[2].structures[1].rays[0].ns.iter_mut().for_each(|ns| *ns = *ns * 97 / 100);
    let markets = result(&epochs, 1);
    let of = pair(&markets[0], "cheap", "dear");
    assert!(matches!(of.rays, Payoff::Rays(_)) && of.high == Payoff::Never, "{of:?}");
}

#[test]
fn the_best_changes_only_where_it_is_overtaken() {
    let offer =
        |structure: &str, build_ns: f64, ns_per_ray: f64| Offer { structure: structure.into(), build_ns, ns_per_ray };
    // The second is beaten by the third before it has beaten the first.
    let offers = [offer("a", 0.0, 10.0), offer("b", 90.0, 9.0), offer("c", 100.0, 5.0), offer("d", 1000.0, 4.0)];
    let best = best(&offers);
    let of: Vec<(&str, f64)> = best.iter().map(|stretch| (stretch.structure.as_str(), stretch.from)).collect();
    assert_eq!(of, [("a", 0.0), ("c", 20.0), ("d", 900.0)]);
}
