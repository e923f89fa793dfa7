//! What may stand in a scene file: the one list that the reader, the JSON schema and the page of the format follow.

/// A kind of table.
#[derive(Debug)]
pub(super) struct Kind {
    /// Its name in messages and headings.
    pub(super) name: &'static str,
    /// What it says.
    pub(super) about: &'static str,
    /// The key whose value decides which others there are.
    pub(super) tag: Option<&'static str>,
    /// Its keys.
    pub(super) keys: &'static [Key],
}

/// A key of a table.
#[derive(Debug)]
pub(super) struct Key {
    /// Its name.
    pub(super) name: &'static str,
    /// Values of the tag that it belongs to; empty for all.
    pub(super) of: &'static [&'static str],
    /// What its value is.
    pub(super) value: Value,
    /// What holds where it is left out.
    pub(super) default: Default,
    /// What it means.
    pub(super) about: &'static str,
}

/// What a value is.
#[derive(Debug)]
pub(super) enum Value {
    /// `true` or `false`.
    Flag,
    /// A finite number.
    Number {
        /// The least that is allowed.
        least: f64,
        /// The greatest that is allowed.
        most: f64,
        /// Its unit, or empty.
        unit: &'static str,
    },
    /// A finite number above 0.
    Positive {
        /// Its unit, or empty.
        unit: &'static str,
    },
    /// A whole number.
    Count {
        /// The least that is allowed.
        least: i64,
        /// The greatest that is allowed.
        most: i64,
    },
    /// Text of a form that `about` describes.
    Text,
    /// The name of a table of this kind.
    Reference(&'static str),
    /// The path of a file, relative to the scene file's folder.
    File,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// So many finite numbers.
    Numbers {
        /// How many.
        count: usize,
        /// Their unit, or empty.
        unit: &'static str,
    },
    /// A number for all axes, or three.
    Scale,
    /// `"#rrggbb"` in sRGB, or three linear numbers from 0 on.
    Color,
    /// Two colours.
    Colors,
    /// Rows of four numbers: three of them, or four.
    Matrix,
    /// Points of three numbers each.
    Points,
    /// Any count of finite numbers.
    NumberList,
    /// Names of files.
    Files,
    /// A table of this kind, or the name of a texture for one that says no more.
    TextureUse(&'static Kind),
    /// One table.
    Table(&'static Kind),
    /// Tables by name.
    Named(&'static Kind),
    /// A list of tables.
    List(&'static Kind),
}

/// What holds where a key is left out.
#[derive(Debug)]
pub(super) enum Default {
    /// It must be given.
    Required,
    /// Something that a value cannot say.
    Is(&'static str),
    /// This number.
    Number(f64),
    /// This whole number.
    Count(i64),
    /// This flag.
    Flag(bool),
    /// This text.
    Text(&'static str),
    /// These numbers.
    Numbers(&'static [f64]),
}

impl Kind {
    /// The key of this name, for a table whose tag has this value.
    #[must_use]
    pub(super) fn key(&self, name: &str, tag: Option<&str>) -> Option<&'static Key> {
        self.keys_of(tag).find(|key| key.name == name)
    }

    /// The keys of a table whose tag has this value; without one, all.
    pub(super) fn keys_of<'a>(
        &self,
        tag: Option<&'a str>,
    ) -> impl Iterator<Item = &'static Key> + use<'a> {
        self.keys.iter().filter(move |key| match tag {
            Some(tag) => key.of.is_empty() || key.of.contains(&tag),
            None => true,
        })
    }
}

impl Value {
    /// What it is, in a few words with range and unit.
    #[must_use]
    pub(super) fn describe(&self) -> String {
        let with = |text: String, unit: &str| {
            if unit.is_empty() {
                text
            } else {
                format!("{text}, {unit}")
            }
        };
        match self {
            Self::Flag => "true or false".to_owned(),
            Self::Number { least, most, unit } => {
                let range = match (least.is_finite(), most.is_finite()) {
                    (true, true) => format!("number, {least} to {most}"),
                    (true, false) => format!("number, {least} or more"),
                    (false, true) => format!("number, at most {most}"),
                    (false, false) => "number".to_owned(),
                };
                with(range, unit)
            }
            Self::Positive { unit } => with("number above 0".to_owned(), unit),
            Self::Count { least, most } => format!("whole number, {least} to {most}"),
            Self::Text => "text".to_owned(),
            Self::Reference(kind) => format!("name of a {kind}"),
            Self::File => "file".to_owned(),
            Self::Choice(words) => words
                .iter()
                .map(|word| format!("`\"{word}\"`"))
                .collect::<Vec<_>>()
                .join(", "),
            Self::Numbers { count, unit } => with(format!("[{count} numbers]"), unit),
            Self::Scale => "number, or [3 numbers]".to_owned(),
            Self::Color => "`\"#rrggbb\"` (sRGB), or [3 numbers] from 0 on (linear)".to_owned(),
            Self::Colors => "[2 colours]".to_owned(),
            Self::Matrix => "[3 or 4 rows of 4 numbers]".to_owned(),
            Self::Points => "[points of 3 numbers]".to_owned(),
            Self::NumberList => "[numbers]".to_owned(),
            Self::Files => "[files]".to_owned(),
            Self::TextureUse(kind) => format!("name of a texture, or {} table", kind.name),
            Self::Table(kind) => format!("{} table", kind.name),
            Self::Named(kind) => format!("{} tables by name", kind.name),
            Self::List(kind) => format!("list of {} tables", kind.name),
        }
    }
}

impl Default {
    /// What it is, as it would be written.
    #[must_use]
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Required => "required".to_owned(),
            Self::Is(what) => (*what).to_owned(),
            Self::Number(number) => format!("`{number}`"),
            Self::Count(number) => format!("`{number}`"),
            Self::Flag(flag) => format!("`{flag}`"),
            Self::Text(text) => format!("`\"{text}\"`"),
            Self::Numbers(numbers) => format!("`{numbers:?}`"),
        }
    }
}
