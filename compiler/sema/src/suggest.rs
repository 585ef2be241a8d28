//! Did-you-mean by edit distance.

/// Number of insertions, deletions, replacements and swaps of neighbours between two words, or `None` above `limit`.
fn distance(a: &[char], b: &[char], limit: usize) -> Option<usize> {
    if a.len().abs_diff(b.len()) > limit {
        return None;
    }
    let mut before = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut last, row);
    }
    Some(last[b.len()]).filter(|&d| d <= limit)
}

/// The candidate closest to `name`, if one is close enough to be a slip; ties go to the first in the alphabet.
pub fn closest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded: Vec<char> = name.chars().take(64).flat_map(char::to_lowercase).collect();
    let limit = (folded.len() / 3).max(1);
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let other: Vec<char> = candidate.chars().flat_map(char::to_lowercase).collect();
        if let Some(d) = distance(&folded, &other, limit)
            && d < folded.len().max(other.len())
            && best.is_none_or(|known| (d, candidate) < known)
        {
            best = Some((d, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::closest;

    #[test]
    fn finds_slips_and_nothing_far_off() {
        let names = ["sphere", "cylinder", "rotate_x", "rotate_y", "pi"];
        assert_eq!(closest("spehre", names), Some("sphere"));
        assert_eq!(closest("Sphere", names), Some("sphere"));
        assert_eq!(closest("cilynder", names), Some("cylinder"));
        assert_eq!(closest("rotate", names), Some("rotate_x"));
        assert_eq!(closest("banana", names), None);
        assert_eq!(closest("q", names), None);
    }
}
