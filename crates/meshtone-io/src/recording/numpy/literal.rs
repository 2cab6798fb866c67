//! The Python literal in which NumPy describes an array.

/// Nesting beyond which a header is none of NumPy's.
const MAX_DEPTH: usize = 8;

/// A Python literal, as far as NumPy writes it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Literal {
    Text(String),
    Number(u64),
    Truth(bool),
    /// A tuple or a list.
    Sequence(Vec<Literal>),
    Dictionary(Vec<(Literal, Literal)>),
}

impl Literal {
    /// Reads a literal; what follows it must be blank.
    pub(super) fn parse(text: &str) -> Option<Literal> {
        let mut rest = text;
        let literal = value(&mut rest, 0)?;
        rest.trim().is_empty().then_some(literal)
    }

    /// The value of a key of a dictionary.
    pub(super) fn get(&self, key: &str) -> Option<&Literal> {
        let Literal::Dictionary(entries) = self else { return None };
        let found = entries.iter().find(|(name, _)| matches!(name, Literal::Text(name) if name == key));
        found.map(|(_, value)| value)
    }
}

fn value(rest: &mut &str, depth: usize) -> Option<Literal> {
    *rest = rest.trim_start();
    let first = rest.chars().next()?;
    if depth > MAX_DEPTH {
        return None;
    }
    match first {
        '\'' | '"' => {
            let (text, after) = rest[1..].split_once(first)?;
            *rest = after;
            (!text.contains('\\')).then(|| Literal::Text(text.to_string()))
        }
        '(' => sequence(rest, ')', depth),
        '[' => sequence(rest, ']', depth),
        '{' => {
            *rest = &rest[1..];
            let mut entries = Vec::new();
            while !closes(rest, '}') {
                let key = value(rest, depth + 1)?;
                *rest = rest.trim_start().strip_prefix(':')?;
                entries.push((key, value(rest, depth + 1)?));
                separates(rest, '}')?;
            }
            Some(Literal::Dictionary(entries))
        }
        _ => word(rest),
    }
}

fn word(rest: &mut &str) -> Option<Literal> {
    let end = rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
    let (word, after) = rest.split_at(end);
    *rest = after;
    match word {
        "True" => Some(Literal::Truth(true)),
        "False" => Some(Literal::Truth(false)),
        // Python 2 wrote long integers with an L.
        number => number.trim_end_matches('L').parse().ok().map(Literal::Number),
    }
}

fn sequence(rest: &mut &str, close: char, depth: usize) -> Option<Literal> {
    *rest = &rest[1..];
    let mut items = Vec::new();
    while !closes(rest, close) {
        items.push(value(rest, depth + 1)?);
        separates(rest, close)?;
    }
    Some(Literal::Sequence(items))
}

/// Whether the closing bracket comes next; it is then passed.
fn closes(rest: &mut &str, close: char) -> bool {
    let after = rest.trim_start().strip_prefix(close);
    after.map(|after| *rest = after).is_some()
}

/// Passes a comma; without one, the closing bracket has to be next.
fn separates(rest: &mut &str, close: char) -> Option<()> {
    *rest = rest.trim_start();
    match rest.strip_prefix(',') {
        Some(after) => {
            *rest = after;
            Some(())
        }
        None => rest.starts_with(close).then_some(()),
    }
}

#[cfg(test)]
mod tests {
    use super::Literal;

    #[test]
    fn literals_of_numpy_are_read() {
        let header =
            "{'descr': [('t', '<f8'), ('a', '<i2', (3,))], 'fortran_order': False, 'shape': (10L, 2), }   \n";
        let literal = Literal::parse(header).unwrap();
        assert_eq!(literal.get("fortran_order"), Some(&Literal::Truth(false)));
        assert_eq!(
            literal.get("shape"),
            Some(&Literal::Sequence(vec![Literal::Number(10), Literal::Number(2)]))
        );
        assert!(matches!(literal.get("descr"), Some(Literal::Sequence(fields)) if fields.len() == 2));
        for broken in [
            "",
            "{",
            "{'a'}",
            "(1 2)",
            "{'a': 1} x",
            "'open",
            "99999999999999999999",
            "((((((((((1))))))))))",
            "ä",
        ] {
            assert_eq!(Literal::parse(broken), None, "{broken}");
        }
    }
}
