//! A reader of as much Markdown as the checks need.

/// `text` with everything inside code (fenced blocks and `spans`) blanked out, line by line, so
/// that lines and columns stay what they were.
pub fn without_code(text: &str) -> Vec<String> {
    let mut fence: Option<&str> = None;
    text.lines()
        .map(|line| {
            let start = line.trim_start();
            let marker = ["```", "~~~"].into_iter().find(|marker| start.starts_with(marker));
            match (fence, marker) {
                (Some(open), Some(close)) if open == close => {
                    fence = None;
                    String::new()
                }
                (Some(_), _) => String::new(),
                (None, Some(open)) => {
                    fence = Some(open);
                    String::new()
                }
                (None, None) => without_code_spans(line),
            }
        })
        .collect()
}

/// One line with its code spans blanked out; a backtick without its partner is text.
fn without_code_spans(line: &str) -> String {
    let mut plain = String::with_capacity(line.len());
    let mut rest = line;
    while let Some(open) = rest.find('`') {
        let ticks = rest[open..].chars().take_while(|&c| c == '`').count();
        let inside = &rest[open + ticks..];
        let Some(length) = inside.find(&rest[open..open + ticks]) else { break };
        plain.push_str(&rest[..open]);
        plain.extend(std::iter::repeat_n(' ', length + 2 * ticks));
        rest = &inside[length + ticks..];
    }
    plain.push_str(rest);
    plain
}

/// The anchors of a page's headings, as mdBook names them.
pub fn anchors(text: &str) -> Vec<String> {
    let mut anchors: Vec<String> = Vec::new();
    for (line, plain) in text.lines().zip(without_code(text)) {
        let level = plain.chars().take_while(|&c| c == '#').count();
        if !(1..=6).contains(&level) || !plain[level..].starts_with(' ') {
            continue;
        }
        let name: String = line[level..].trim().chars().filter_map(anchor_character).collect();
        // The second heading of the same name gets -1, the third -2, …
        let same = anchors.iter().filter(|known| **known == name || is_numbered(known, &name)).count();
        anchors.push(if same == 0 { name } else { format!("{name}-{same}") });
    }
    anchors
}

/// Returns whether `anchor` is `name` with a number behind it.
fn is_numbered(anchor: &str, name: &str) -> bool {
    anchor
        .strip_prefix(name)
        .and_then(|rest| rest.strip_prefix('-'))
        .is_some_and(|number| !number.is_empty() && number.chars().all(|c| c.is_ascii_digit()))
}

/// Character of an anchor for a character of its heading.
fn anchor_character(c: char) -> Option<char> {
    match c {
        _ if c.is_alphanumeric() => Some(c.to_ascii_lowercase()),
        '_' | '-' => Some(c),
        _ if c.is_whitespace() => Some('-'),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_is_blanked_and_columns_stay() {
        let lines = without_code("a `b` c\n```sh\n[x](y)\n```\n``d ` e`` f");
        assert_eq!(lines, ["a     c", "", "", "", "          f"]);
    }

    #[test]
    fn headings_have_anchors() {
        let text = "# Two words\n## `gears.module_mm`\n```\n# no\n```\n### Two words\n#not\n";
        assert_eq!(anchors(text), ["two-words", "gearsmodule_mm", "two-words-1"]);
    }
}
