//! The values that a page tries out in place of a scene's text, and their way into the text.

use super::numbers;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use tabray_core::scene::value::Datum;
use tabray_editor::{self as editor, Text, View, Word};
use tabray_lang::registry::Registry;
use tabray_lang::syntax::Syntax;

/// A value that is tried out, as a page sends it.
#[derive(Deserialize)]
pub struct Try {
    /// The name of the object.
    pub name: String,
    /// The name of the attribute.
    pub attribute: String,
    /// All its values, as a scene writes them.
    pub values: Vec<String>,
}

impl Try {
    /// Reads what a page sends; `None` if the values are not numbers.
    pub fn of(body: &[u8]) -> Option<Self> {
        let tried: Self = serde_json::from_slice(body).ok()?;
        let are_numbers = tried.values.iter().all(|value| value.parse::<f64>().is_ok());
        (are_numbers && !tried.values.is_empty()).then_some(tried)
    }
}

/// An attribute, as a page names it.
#[derive(Deserialize)]
pub struct Which {
    /// The name of the object.
    pub name: String,
    /// The name of the attribute.
    pub attribute: String,
}

/// Values that are tried out and differ from those in the text.
#[derive(Serialize)]
pub struct Difference {
    /// The name of the object.
    name: String,
    /// The name of the attribute.
    attribute: String,
    /// The values that are tried out.
    values: Vec<String>,
    /// The values in the text; empty where it has none.
    text: Vec<String>,
}

/// The values of all attributes that are tried out.
#[derive(Default)]
pub struct TrialValues(Mutex<BTreeMap<(String, String), Vec<String>>>);

impl TrialValues {
    fn all(&self) -> MutexGuard<'_, BTreeMap<(String, String), Vec<String>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Tries out other values of an attribute. Returns `None` if they are not numbers.
    pub fn set(&self, body: &[u8]) -> Option<()> {
        let Try { name, attribute, values } = Try::of(body)?;
        self.all().insert((name, attribute), values);
        Some(())
    }

    /// Tries out other numbers of an attribute.
    pub fn put(&self, name: &str, attribute: &str, numbers: &[f64]) {
        let values = Syntax::Notes.values(&Datum::Numbers(numbers.to_vec()));
        self.all().insert((name.to_owned(), attribute.to_owned()), values);
    }

    /// Returns the numbers of an attribute that are tried out, if there are any.
    pub fn get(&self, name: &str, attribute: &str) -> Option<Vec<f64>> {
        let all = self.all();
        let values = all.get(&(name.to_owned(), attribute.to_owned()))?;
        values.iter().map(|value| value.parse().ok()).collect()
    }

    /// Tells whether nothing is tried out.
    pub fn is_empty(&self) -> bool {
        self.all().is_empty()
    }

    /// Lists the values that differ from those in the text.
    pub fn differences(&self, view: &View) -> Vec<Difference> {
        let difference = |((name, attribute), values): (&(String, String), &Vec<String>)| {
            let text: Vec<_> =
                given(view, name, attribute).iter().map(|word| view.word(*word).into_owned()).collect();
            let numbers =
                |all: &[String]| all.iter().map(|value| value.parse::<f64>().ok()).collect::<Vec<_>>();
            let is_same = numbers(&text) == numbers(values);
            let (name, attribute, values) = (name.clone(), attribute.clone(), values.clone());
            (!is_same).then_some(Difference { name, attribute, values, text })
        };
        self.all().iter().filter_map(difference).collect()
    }

    /// Returns to the values of the text in one attribute, or in all.
    pub fn discard(&self, which: Option<&Which>) {
        self.all().retain(|key, _| which.is_some_and(|which| !is(key, which)));
    }

    /// Returns to the values of the text in one object.
    pub fn clear_of(&self, name: &str) {
        self.all().retain(|(of, _), _| of != name);
    }

    /// Returns the values as `--set` takes them.
    pub fn sets(&self) -> Vec<String> {
        let set = |((name, attribute), values): (&(String, String), &Vec<String>)| {
            let of = if name == numbers::NAME { String::new() } else { Syntax::Notes.key(name) + "." };
            format!("{of}{attribute}={}", values.join(" "))
        };
        self.all().iter().map(set).collect()
    }

    /// Writes the values of one attribute, or of all, into a scene's text, and changes nothing else in it.
    ///
    /// # Errors
    /// The name of an object or a number that the text does not define in one place.
    pub fn written(
        &self,
        registry: &Registry,
        file: &str,
        text: &str,
        only: Option<&Which>,
    ) -> Result<String, String> {
        let mut text = Text::new(text);
        let all = self.all();
        for (key, values) in all.iter().filter(|(key, _)| only.is_none_or(|only| is(key, only))) {
            let (name, attribute) = key;
            let view = editor::read(registry, file, text);
            let what = if name == numbers::NAME { attribute } else { name };
            text = write(&view, name, attribute, values).ok_or_else(|| what.clone())?;
        }
        Ok(text.as_str().to_owned())
    }
}

fn is((name, attribute): &(String, String), which: &Which) -> bool {
    (name, attribute) == (&which.name, &which.attribute)
}

/// Returns the values of an attribute or of a number as the text gives them; none where it does not.
pub fn given(view: &View, name: &str, attribute: &str) -> Vec<Word> {
    if name == numbers::NAME {
        return numbers::value(view, attribute).into_iter().collect();
    }
    let is_meant = |given: &&editor::Attribute| given.known.is_some_and(|known| known.name() == attribute);
    let given = view.entity(name).and_then(|entity| entity.attributes.iter().find(is_meant));
    given.map_or_else(Vec::new, |given| given.values.clone())
}

/// Writes the values of one attribute, or of a number, into a text, and changes nothing else in it; `None` where the
/// text does not define it in one place.
pub fn write(view: &View, name: &str, attribute: &str, values: &[String]) -> Option<Text> {
    let given = given(view, name, attribute);
    let (Some(first), Some(last)) = (given.first(), given.last()) else {
        let (at, between) = view.room(view.entity(name)?);
        let usage = view.syntax.pair(attribute, values);
        return Some(view.text.edited(at..at, &format!("{between}{usage}")));
    };
    if given.len() == values.len() {
        let mut text = view.text.clone();
        for (word, value) in given.iter().zip(values).rev() {
            text = text.edited(word.place(), value);
        }
        return Some(text);
    }
    let joined = match view.syntax {
        Syntax::Notes => values.join(" "),
        Syntax::Toml if given.len() == 1 => format!("[{}]", values.join(", ")),
        Syntax::Toml => values.join(", "),
    };
    Some(view.text.edited(first.start..last.end, &joined))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(file: &str, text: &str, trial_values: &[(&str, &str, &[&str])]) -> Result<String, String> {
        let all = TrialValues::default();
        for (name, attribute, values) in trial_values {
            let body =
                serde_json::json!({ "name": name, "attribute": attribute, "values": values }).to_string();
            all.set(body.as_bytes()).expect("numbers");
        }
        all.written(Registry::get().expect("plugins"), file, text, None)
    }

    #[test]
    fn what_is_tried_is_written_and_nothing_else_changes() {
        let text = "# two\nsphere ball { center 1   2 # up\n 3  radius 1 material red } # end\n";
        let trial_values: &[(&str, &str, &[&str])] =
            &[("ball", "radius", &["2.5"]), ("ball", "center", &["4", "5", "6"])];
        let after = "# two\nsphere ball { center 4   5 # up\n 6  radius 2.5 material red } # end\n";
        assert_eq!(written("a.ray", text, trial_values), Ok(after.to_owned()));
        let text = "[sphere.ball]\ncenter = [1, 2, 3] # here\nradius = 1\n";
        let after = "[sphere.ball]\ncenter = [4, 5, 6] # here\nradius = 2.5\n";
        assert_eq!(written("a.toml", text, trial_values), Ok(after.to_owned()));
    }

    #[test]
    fn an_attribute_that_the_text_lacks_is_added_to_it() {
        let trial_values: &[(&str, &str, &[&str])] = &[("t", "shininess", &["9"])];
        let on_one = written("a.ray", "material t { diffuse 1 1 1 }", trial_values);
        assert_eq!(on_one, Ok("material t { diffuse 1 1 1  shininess 9 }".to_owned()));
        let on_lines = written("a.ray", "material t\n{\n    diffuse 1 1 1\n}\n", trial_values);
        assert_eq!(on_lines, Ok("material t\n{\n    diffuse 1 1 1\n    shininess 9\n}\n".to_owned()));
        let toml = written("a.toml", "[material.t]\ndiffuse = [1, 1, 1]\n", trial_values);
        assert_eq!(toml, Ok("[material.t]\ndiffuse = [1, 1, 1]\nshininess = 9\n".to_owned()));
    }

    #[test]
    fn a_named_number_is_set_and_written() {
        let trial_values: &[(&str, &str, &[&str])] = &[("", "k", &["2.5"])];
        for (file, text) in [
            ("a.ray", "let k 0.5 # here\nlet f(u) \"k*u\"\nsphere ball { radius \"k\" }"),
            ("a.ray", "let k \"0.5\"\nrepeat i 2 { let k 7 sphere ball { radius \"k\" } }"),
            ("a.toml", "[let]\nk = 0.5 # here\n[sphere.ball]\nradius = \"k\"\n"),
        ] {
            let after = text.replace("\"0.5\"", "2.5").replace("0.5", "2.5");
            assert_eq!(written(file, text, trial_values), Ok(after));
        }
        let unknown = written("a.ray", "let k \"1 + 1\"", trial_values);
        assert_eq!(unknown, Err("k".to_owned()), "a formula stays");
        let all = TrialValues::default();
        all.put("", "k", &[2.5]);
        assert_eq!(all.sets(), ["k=2.5"]);
        let view = editor::read(Registry::get().expect("plugins"), "a.ray", Text::new("let k 0.5"));
        assert_eq!(all.differences(&view)[0].text, ["0.5"]);
    }

    #[test]
    fn what_the_text_repeats_is_not_written() {
        let text = "repeat i 2 { sphere ball { radius 1 } }";
        assert_eq!(written("a.ray", text, &[("ball", "radius", &["2"])]), Err("ball".to_owned()));
    }

    #[test]
    fn what_the_text_says_already_is_no_difference() {
        let all = TrialValues::default();
        all.put("ball", "radius", &[2.0]);
        all.put("ball", "center", &[1.0, 2.0, 4.0]);
        let registry = Registry::get().expect("plugins");
        for (file, text) in [
            ("a.ray", "sphere ball { center 1 2 3 radius 2.0 }"),
            ("a.toml", "[sphere.ball]\ncenter = [1, 2, 3]\nradius = 2\n"),
        ] {
            let differences = all.differences(&editor::read(registry, file, Text::new(text)));
            let [Difference { name, attribute, values, text }] = &differences[..] else { panic!("one") };
            assert_eq!((&**name, &**attribute), ("ball", "center"));
            assert_eq!((values.join(" "), text.join(" ")), ("1 2 4".to_owned(), "1 2 3".to_owned()));
        }
    }

    #[test]
    fn only_numbers_are_tried() {
        for values in ["[]", "[\"1; rm\"]", "[\"1\\\"\"]", "7"] {
            let body = format!("{{\"name\":\"a\",\"attribute\":\"b\",\"values\":{values}}}");
            assert_eq!(TrialValues::default().set(body.as_bytes()), None, "{body}");
        }
    }
}
