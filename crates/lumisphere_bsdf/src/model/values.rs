//! Names and values as people write them.

use super::{MODELS, Model, Parameter, Range};
use crate::BsdfError;

/// The model of this name.
///
/// # Errors
/// [`BsdfError::UnknownModel`], with the names there are.
pub fn model_named(name: &str) -> Result<&'static Model, BsdfError> {
    let known = || MODELS.iter().map(|model| model.name).collect::<Vec<_>>().join(", ");
    let found = MODELS.iter().find(|model| model.name == name).copied();
    found.ok_or_else(|| BsdfError::UnknownModel { found: name.to_owned(), known: known() })
}

impl Model {
    /// The values of `name=value` words over the defaults. A name may be cut short while it stays the only one that begins so.
    ///
    /// # Errors
    /// [`BsdfError::UnknownParameter`], with the names there are, and [`BsdfError::ParameterText`], with what it may be.
    pub fn values_of<'a>(&self, words: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Vec<f64>, BsdfError> {
        let mut values = self.defaults();
        for (name, text) in words {
            let index = self.parameter_index(name)?;
            values[index] = self.parameters[index].parse(text)?;
        }
        Ok(values)
    }

    fn parameter_index(&self, name: &str) -> Result<usize, BsdfError> {
        if let Some(exact) = self.parameters.iter().position(|p| p.name == name) {
            return Ok(exact);
        }
        let mut matching = (0..self.parameters.len()).filter(|&i| self.parameters[i].name.starts_with(name));
        match (matching.next(), matching.next()) {
            (Some(only), None) if !name.is_empty() => Ok(only),
            _ => Err(BsdfError::UnknownParameter {
                model: self.name,
                found: name.to_owned(),
                known: self.parameters.iter().map(|p| p.name).collect::<Vec<_>>().join(", "),
            }),
        }
    }
}

impl Parameter {
    /// The value of a text: a number in the range, or one of the words.
    ///
    /// # Errors
    /// [`BsdfError::ParameterText`].
    pub fn parse(&self, text: &str) -> Result<f64, BsdfError> {
        let value = match self.range {
            Range::Number(min, max) => text.parse::<f64>().ok().filter(|value| (min..=max).contains(value)),
            Range::Choice(words) => words.iter().position(|&word| word == text).map(|index| index as f64),
        };
        value.ok_or_else(|| BsdfError::ParameterText {
            parameter: self.name,
            found: text.to_owned(),
            expected: self.range.to_string(),
        })
    }

    /// The value as people write it: the number, or the word.
    pub fn text(&self, value: f64) -> String {
        match self.range {
            Range::Number(..) => value.to_string(),
            Range::Choice(words) => words.get(value as usize).copied().unwrap_or_default().to_owned(),
        }
    }

    pub(crate) fn check(&self, value: f64) -> Result<(), BsdfError> {
        let fits = match self.range {
            Range::Number(min, max) => (min..=max).contains(&value),
            Range::Choice(words) => value.fract() == 0.0 && (0.0..words.len() as f64).contains(&value),
        };
        let expected = || self.range.to_string();
        if fits {
            Ok(())
        } else {
            Err(BsdfError::ParameterValue { parameter: self.name, found: value, expected: expected() })
        }
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(min, max) => write!(f, "{min} to {max}"),
            Self::Choice(words) => f.write_str(&words.join(", ")),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_probes_are_in_range() {
        for (index, model) in MODELS.iter().enumerate() {
            assert!(MODELS[index + 1..].iter().all(|other| other.name != model.name), "{}", model.name);
            for parameter in model.parameters {
                let values = parameter.probes.iter().chain([&parameter.default]);
                values.for_each(|&value| parameter.check(value).unwrap());
                assert!(!parameter.probes.is_empty(), "{} {}", model.name, parameter.name);
            }
        }
    }

    #[test]
    fn pages_show_source_and_every_range() {
        for model in MODELS {
            let page = model.page();
            assert!(page.contains("Source:"), "{}: no source", model.name);
            for parameter in model.parameters {
                let row =
                    format!("| `{}` | {} | {} |", parameter.name, parameter.range, parameter.text(parameter.default));
                assert!(page.contains(&row), "{}: its page lacks the row {row}", model.name);
            }
        }
    }

    #[test]
    fn wrong_words_are_refused_with_what_is_right() {
        assert!(model_named("lambertt").unwrap_err().to_string().contains("lambert"));
        let lambert = model_named("lambert").unwrap();
        assert_eq!(lambert.values_of([("alb", "0.25")]).unwrap(), [0.25]);
        for (name, text) in [("colour", "1"), ("", "1"), ("albedo", "2"), ("albedo", "NaN"), ("albedo", "x")] {
            assert!(lambert.values_of([(name, text)]).is_err(), "{name}={text}");
        }
    }
}
