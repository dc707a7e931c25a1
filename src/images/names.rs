//! Finds values by name, ignoring case. Suggests corrections of misspelled names.

/// Declares an enum with a text name for each value.
#[macro_export]
macro_rules! named_enum {
    ($(#[$doc:meta])* pub enum $type:ident { $($(#[$of:meta])* $value:ident = $name:literal,)* }) => {
        $(#[$doc])*
        pub enum $type {
            $($(#[$of])* $value,)*
        }

        impl $type {
            /// All values, in the order of their declaration. Tables use this order.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$value),*];

            /// The name of the value in commands, output and files.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$value => $name),*
                }
            }
        }
    };
}
pub use named_enum;

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no {what} {name:?}{}; the choices are: {}", suggestion(name, known.iter().copied()), known.join(", "))]
pub struct Unknown {
    what: &'static str,
    name: String,
    known: Vec<&'static str>,
}

/// `what` is the noun in the error message.
pub fn find<T: Copy, const N: usize>(
    what: &'static str,
    all: [T; N],
    wanted: &str,
    name: fn(T) -> &'static str,
) -> Result<T, Unknown> {
    named(all, wanted, |&one| name(one)).ok_or_else(|| Unknown {
        what,
        name: wanted.into(),
        known: all.map(name).into(),
    })
}

pub fn named<T>(known: impl IntoIterator<Item = T>, wanted: &str, name: impl Fn(&T) -> &str) -> Option<T> {
    known.into_iter().find(|one| name(one).eq_ignore_ascii_case(wanted))
}

/// The element of `known` that `wanted` probably means. Swapped neighbouring letters count as one difference.
///
/// # References
/// Damerau, A technique for computer detection and correction of spelling errors, 1964.
pub fn nearest<'a>(wanted: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted: String = wanted.chars().take(60).flat_map(char::to_lowercase).collect();
    let known: Vec<&str> = known.into_iter().collect();
    let distance = |name: &str| strsim::osa_distance(&wanted, &name.to_lowercase());
    let best = known.iter().copied().min_by_key(|name| distance(name))?;
    if 3 * distance(best) <= wanted.chars().count().max(best.chars().count()) {
        return Some(best);
    }
    let mut begins = known.into_iter().filter(|name| wanted.len() > 2 && name.to_lowercase().starts_with(&wanted));
    begins.next().filter(|_| begins.next().is_none())
}

pub fn suggestion<'a>(wanted: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(wanted, known).map_or(String::new(), |name| format!(" (did you mean {name}?)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENES: [&str; 5] = ["Cube", "Sponza", "Dragon", "Cornellbox", "Infinitycandy"];

    #[test]
    fn a_slip_is_understood_and_another_word_is_not() {
        let meant = |wanted| nearest(wanted, SCENES);
        assert_eq!(meant("sponsa"), Some("Sponza"));
        assert_eq!(meant("dargon"), Some("Dragon"));
        assert_eq!(meant("cub"), Some("Cube"));
        assert_eq!(meant("corn"), Some("Cornellbox"));
        for other in ["foo", "", "octree", "a long word that nobody knows", "c"] {
            assert_eq!(meant(other), None, "{other}");
        }
        assert_eq!(nearest("sah", ["sah-kd", "sah-bvh"]), None, "two begin so");
        assert_eq!(suggestion("CUEB", SCENES), " (did you mean Cube?)");
    }

    named_enum! {
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Fruit {
            Apple = "apple",
            SourCherry = "sour-cherry",
        }
    }

    #[test]
    fn a_name_that_is_none_gets_the_list() {
        let fruit = |wanted| find("fruit", Fruit::ALL, wanted, Fruit::name);
        assert_eq!(Fruit::ALL.map(|one| fruit(one.name())), Fruit::ALL.map(Ok));
        let refused = fruit("appel").unwrap_err().to_string();
        assert_eq!((fruit("APPLE"), named(SCENES, "Drago", |name| name)), (Ok(Fruit::Apple), None));
        assert_eq!(refused, "there is no fruit \"appel\" (did you mean apple?); the choices are: apple, sour-cherry");
    }
}
