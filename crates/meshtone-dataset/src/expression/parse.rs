//! Reading expressions and conditions.

use super::{Comparison, Node, Operation};

/// (characters) Length above which a text is refused, because it could be nested too deep.
const LONGEST: usize = 1000;
const MOST_NESTED: usize = 50;

/// Operators by their precedence: those that bind least come first.
const OPERATORS: [[(&str, Operation); 2]; 2] =
    [[("+", Operation::Plus), ("-", Operation::Minus)], [("*", Operation::Times), ("/", Operation::Over)]];

/// Symbols that others begin with come after those.
const COMPARISONS: [(&str, Comparison); 6] = [
    ("<=", Comparison::AtMost),
    (">=", Comparison::AtLeast),
    ("==", Comparison::Equal),
    ("!=", Comparison::Unequal),
    ("<", Comparison::Less),
    (">", Comparison::More),
];

pub(super) fn expression(text: &str) -> Result<Node, String> {
    let mut reader = Reader::new(text)?;
    let node = reader.operation(0)?;
    reader.end()?;
    Ok(node)
}

pub(super) fn condition(text: &str) -> Result<(Node, Comparison, Node), String> {
    let mut reader = Reader::new(text)?;
    let left = reader.operation(0)?;
    let comparison = reader.comparison()?;
    let right = reader.operation(0)?;
    reader.end()?;
    Ok((left, comparison, right))
}

struct Reader<'a> {
    rest: &'a str,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str) -> Result<Self, String> {
        if text.len() > LONGEST {
            return Err(format!("has {} characters; must have at most {LONGEST}", text.len()));
        }
        Ok(Self { rest: text.trim_start(), depth: 0 })
    }

    fn skip(&mut self, bytes: usize) {
        self.rest = self.rest[bytes..].trim_start();
    }

    fn take(&mut self, symbol: &str) -> bool {
        let found = self.rest.starts_with(symbol);
        if found {
            self.skip(symbol.len());
        }
        found
    }

    fn end(&self) -> Result<(), String> {
        if self.rest.is_empty() { Ok(()) } else { Err(self.unexpected("an operator or the end")) }
    }

    fn unexpected(&self, wanted: &str) -> String {
        if self.rest.is_empty() {
            return format!("ends where {wanted} is expected");
        }
        let found: String = self.rest.chars().take(20).collect();
        format!("has `{found}` where {wanted} is expected")
    }

    fn comparison(&mut self) -> Result<Comparison, String> {
        let found = COMPARISONS.into_iter().find(|(symbol, _)| self.take(symbol));
        found.map(|(_, comparison)| comparison).ok_or_else(|| self.unexpected("<, <=, >, >=, == or !="))
    }

    /// Reads operations of a precedence and of all that bind more.
    fn operation(&mut self, precedence: usize) -> Result<Node, String> {
        let Some(operators) = OPERATORS.get(precedence) else { return self.factor() };
        let mut left = self.operation(precedence + 1)?;
        while let Some((_, operation)) = operators.iter().find(|(symbol, _)| self.take(symbol)) {
            left = Node::Of(*operation, Box::new([left, self.operation(precedence + 1)?]));
        }
        Ok(left)
    }

    fn factor(&mut self) -> Result<Node, String> {
        self.depth += 1;
        if self.depth > MOST_NESTED {
            return Err("is nested too deep".to_owned());
        }
        let node = self.factor_at_depth();
        self.depth -= 1;
        node
    }

    fn factor_at_depth(&mut self) -> Result<Node, String> {
        if self.take("-") {
            return Ok(Node::Negative(Box::new(self.factor()?)));
        }
        if self.take("(") {
            let inside = self.operation(0)?;
            return if self.take(")") { Ok(inside) } else { Err(self.unexpected("`)`")) };
        }
        match self.rest.chars().next() {
            Some(first) if first.is_ascii_digit() || first == '.' => self.number(),
            Some(first) if first.is_ascii_alphabetic() => Ok(self.key()),
            _ => Err(self.unexpected("a number, a key or `(`")),
        }
    }

    fn number(&mut self) -> Result<Node, String> {
        let bytes = self.rest.as_bytes();
        let is_part = |i: usize| match bytes[i] {
            b'0'..=b'9' | b'.' | b'e' | b'E' => true,
            b'+' | b'-' => i > 0 && bytes[i - 1].eq_ignore_ascii_case(&b'e'),
            _ => false,
        };
        let len = (0..bytes.len()).find(|&i| !is_part(i)).unwrap_or(bytes.len());
        let number = self.rest[..len].parse::<f64>().ok().filter(|number| number.is_finite());
        let number = number.ok_or_else(|| format!("has `{}`, which is no number", &self.rest[..len]))?;
        self.skip(len);
        Ok(Node::Number(number))
    }

    fn key(&mut self) -> Node {
        // What stands in brackets is the name of an entry of a list, in which there may be any sign.
        let mut inside = false;
        let mut is_part = |c: char| {
            inside = (inside || c == '[') && c != ']';
            inside || c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | ']')
        };
        let len = self.rest.find(|c| !is_part(c)).unwrap_or(self.rest.len());
        let key = self.rest[..len].to_owned();
        self.skip(len);
        Node::Key(key)
    }
}

#[cfg(test)]
mod tests {
    use crate::expression::{Condition, Expression};

    fn value(text: &str) -> f64 {
        let number = |key: &str| match key {
            "gears.module_mm" => Some(3.0),
            "fault.start" => Some(0.25),
            _ => None,
        };
        Expression::parse(text).unwrap().value(&number).unwrap()
    }

    #[test]
    fn the_usual_order_of_operations() {
        assert_eq!(value("1 + 2 * 3 - 4 / 2"), 5.0);
        assert_eq!(value("(1 + 2) * -(3 - 4)"), 3.0);
        assert_eq!(value("2.25*gears.module_mm"), 6.75);
        assert_eq!(value("1e-3 + fault.start"), 0.251);
        assert_eq!(value("8 / 4 / 2"), 1.0);
    }

    #[test]
    fn what_cannot_be_understood_is_reported() {
        for (text, words) in [
            ("", "ends where a number"),
            ("2 *", "ends where a number"),
            ("(1 + 2", "ends where `)`"),
            ("1 2", "has `2` where an operator"),
            ("1 < 2", "has `< 2` where an operator"),
            ("ä", "has `ä` where"),
            ("1.2.3", "no number"),
            (&"(".repeat(500), "too deep"),
            (&"-".repeat(500), "too deep"),
            (&"1".repeat(2000), "2000 characters"),
        ] {
            let error = Expression::parse(text).unwrap_err();
            assert!(error.contains(words), "{text}: {error}");
        }
        assert!(Condition::parse("1 + 2").unwrap_err().contains("<="));
        assert!(Condition::parse("1 < 2 < 3").is_err());
    }
}
