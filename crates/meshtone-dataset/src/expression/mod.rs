//! Numbers computed from a scenario's keys, and conditions on them, as a plan writes them.
//!
//! `+ - * /`, parentheses, numbers and dotted keys of the scenario file. A condition is two such terms with `<`, `<=`, `>`,
//! `>=`, `==` or `!=` between them.

mod parse;

use std::fmt;
use std::sync::LazyLock;

/// A number computed from keys.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    text: String,
    root: Node,
}

/// A comparison of two numbers, which holds or not.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    text: String,
    left: Node,
    comparison: Comparison,
    right: Node,
}

#[derive(Debug, Clone, PartialEq)]
enum Node {
    Number(f64),
    Key(String),
    Negative(Box<Node>),
    Of(Operation, Box<[Node; 2]>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Operation {
    Plus,
    Minus,
    Times,
    Over,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Comparison {
    Less,
    AtMost,
    More,
    AtLeast,
    Equal,
    Unequal,
}

impl Expression {
    /// Reads an expression.
    ///
    /// # Arguments
    /// * `text` - as in a plan
    ///
    /// # Errors
    /// What cannot be understood, in words.
    ///
    /// ```
    /// use meshtone_dataset::expression::Expression;
    ///
    /// let height = Expression::parse("2.25 * gears.module_mm")?;
    /// assert_eq!(height.value(&|key| (key == "gears.module_mm").then_some(2.0)), Some(4.5));
    /// assert!(Expression::parse("2 *").is_err());
    /// # Ok::<(), String>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, String> {
        Ok(Self { text: text.to_owned(), root: parse::expression(text)? })
    }

    /// The value; none where a key has none.
    ///
    /// # Arguments
    /// * `number` - the number at a key
    pub fn value(&self, number: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
        self.root.value(number)
    }

    /// The keys that it depends on.
    pub fn keys(&self) -> Vec<&str> {
        self.root.keys()
    }
}

impl Condition {
    /// Reads a condition.
    ///
    /// # Arguments
    /// * `text` - as in a plan
    ///
    /// # Errors
    /// What cannot be understood, in words.
    ///
    /// ```
    /// use meshtone_dataset::expression::Condition;
    ///
    /// let fast = Condition::parse("operation.pinion_speed_hz >= 50")?;
    /// assert_eq!(fast.holds(&|_| Some(50.0)), Some(true));
    /// assert_eq!(fast.holds(&|_| None), None);
    /// # Ok::<(), String>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, String> {
        let (left, comparison, right) = parse::condition(text)?;
        Ok(Self { text: text.to_owned(), left, comparison, right })
    }

    /// Returns whether it holds; none where a key has no number.
    ///
    /// # Arguments
    /// * `number` - the number at a key
    pub fn holds(&self, number: &dyn Fn(&str) -> Option<f64>) -> Option<bool> {
        let (left, right) = (self.left.value(number)?, self.right.value(number)?);
        Some(match self.comparison {
            Comparison::Less => left < right,
            Comparison::AtMost => left <= right,
            Comparison::More => left > right,
            Comparison::AtLeast => left >= right,
            Comparison::Equal => left == right,
            Comparison::Unequal => left != right,
        })
    }

    /// The keys that it depends on.
    pub fn keys(&self) -> Vec<&str> {
        [self.left.keys(), self.right.keys()].concat()
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.text)
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.text)
    }
}

impl Node {
    fn value(&self, number: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
        Some(match self {
            Self::Number(value) => *value,
            Self::Key(key) => number(key)?,
            Self::Negative(node) => -node.value(number)?,
            Self::Of(operation, nodes) => {
                let [left, right] = &**nodes;
                let (left, right) = (left.value(number)?, right.value(number)?);
                match operation {
                    Operation::Plus => left + right,
                    Operation::Minus => left - right,
                    Operation::Times => left * right,
                    Operation::Over => left / right,
                }
            }
        })
    }

    fn keys(&self) -> Vec<&str> {
        match self {
            Self::Number(_) => Vec::new(),
            Self::Key(key) => vec![key],
            Self::Negative(node) => node.keys(),
            Self::Of(_, nodes) => nodes.iter().flat_map(Self::keys).collect(),
        }
    }
}

/// Names that stand for a number computed from keys, and how.
const DERIVED: [(&str, &str); 5] = [
    ("tooth.height_mm", "2.25 * gears.module_mm"),
    ("tooth.thickness_mm", "1.5707963267948966 * gears.module_mm"),
    ("gears.ratio", "gears.gear_teeth / gears.pinion_teeth"),
    ("operation.gear_speed_hz", "operation.pinion_speed_hz * gears.pinion_teeth / gears.gear_teeth"),
    ("operation.mesh_frequency_hz", "operation.pinion_speed_hz * gears.pinion_teeth"),
];

/// Returns the expression that a derived name stands for; none for another name.
///
/// ```
/// use meshtone_dataset::expression::derived;
///
/// assert_eq!(derived("gears.ratio").unwrap().keys(), ["gears.gear_teeth", "gears.pinion_teeth"]);
/// assert!(derived("gears.module_mm").is_none());
/// ```
pub fn derived(name: &str) -> Option<&'static Expression> {
    static PARSED: LazyLock<Vec<(&str, Expression)>> = LazyLock::new(|| {
        DERIVED.iter().filter_map(|(name, text)| Some((*name, Expression::parse(text).ok()?))).collect()
    });
    PARSED.iter().find(|(derived, _)| *derived == name).map(|(_, expression)| expression)
}

/// All derived names.
pub fn derived_names() -> impl Iterator<Item = &'static str> {
    DERIVED.iter().map(|(name, _)| *name)
}

/// The keys of the scenario file behind some names, derived ones replaced by what they are computed from.
///
/// # Arguments
/// * `names` - as expressions have them
pub fn underlying<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let of = |name: &'a str| derived(name).map_or_else(|| vec![name], |expression| expression.keys());
    names.into_iter().flat_map(of).collect()
}
