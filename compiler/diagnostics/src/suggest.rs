//! Did-you-mean by edit distance.

/// The candidate closest to `name`, if it is close enough to be a slip: at most a third of the letters differ. Upper and
/// lower case count as equal; of equally close ones the first in the alphabet is given.
pub fn closest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = folded(name);
    let limit = (name.len() / 3).max(1);
    candidates
        .into_iter()
        .filter_map(|candidate| {
            let other = folded(candidate);
            let distance = distance(&name, &other, limit)?;
            (distance < name.len().max(other.len())).then_some((distance, candidate))
        })
        .min()
        .map(|(_, candidate)| candidate)
}

/// The letters that count; nobody misspells the end of a name this long.
fn folded(name: &str) -> Vec<char> {
    name.chars().take(64).flat_map(char::to_lowercase).collect()
}

/// Insertions, deletions, replacements and swaps of neighbours between two words (optimal string alignment), `None`
/// above the limit.
fn distance(a: &[char], b: &[char], limit: usize) -> Option<usize> {
    if a.len().abs_diff(b.len()) > limit {
        return None;
    }
    let mut before_last = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before_last[j - 2] + 1);
            }
        }
        before_last = std::mem::replace(&mut last, row);
    }
    Some(last[b.len()]).filter(|&distance| distance <= limit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_find_their_word_and_other_words_do_not() {
        let words = ["sphere", "torus", "cylinder", "scene"];
        for (slip, word) in [("spere", "sphere"), ("Torsu", "torus"), ("cilinder", "cylinder"), ("secne", "scene")] {
            assert_eq!(closest(slip, words), Some(word), "{slip}");
        }
        for other in ["cube", "x", "", "spherical_harmonics"] {
            assert_eq!(closest(other, words), None, "{other}");
        }
        assert_eq!(closest("rotate", ["rotate_y", "rotate_x"]), Some("rotate_x"), "the first in the alphabet");
        assert_eq!(closest("q", ["pi"]), None);
    }
}
