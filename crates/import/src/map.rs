//! Which column of a table, or which variable of a MATLAB file, is which FRF.

use crate::ChannelPair;

/// The analyst's word on columns and variables.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ColumnMap {
    entries: Vec<ColumnEntry>,
}

/// One entry: `H1=4/1 [m/s^2/N]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnEntry {
    /// Name of the column, variable or file; `None` for a file that holds one FRF.
    pub(crate) name: Option<String>,
    /// Which FRF it is.
    pub(crate) pair: ChannelPair,
    /// Its unit, if stated.
    pub(crate) unit: Option<String>,
    /// The entry as it was written.
    pub text: String,
}

/// Why an entry makes no sense.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` does not say which column is which FRF, such as `H1=4/1 [m/s^2/N]`, or `4:+z/1:+z` for a file of one FRF"
)]
pub struct ColumnMapError(String);

impl ColumnMap {
    /// Reads entries.
    ///
    /// # Errors
    /// The first entry that is none.
    pub fn parse<T: AsRef<str>>(entries: impl IntoIterator<Item = T>) -> Result<Self, ColumnMapError> {
        let entries = entries.into_iter().map(|text| ColumnEntry::parse(text.as_ref()));
        Ok(ColumnMap { entries: entries.collect::<Result<_, _>>()? })
    }

    /// The entries.
    pub fn entries(&self) -> &[ColumnEntry] {
        &self.entries
    }

    /// The entry of a column or variable, and its position.
    pub(crate) fn of_name(&self, name: &str) -> Option<(usize, &ColumnEntry)> {
        let same =
            |entry: &ColumnEntry| entry.name.as_deref().is_some_and(|n| n.eq_ignore_ascii_case(name.trim()));
        self.entries.iter().enumerate().find(|(_, entry)| same(entry))
    }

    /// An entry without name of this FRF: it states the unit of one that the file names.
    pub(crate) fn of_pair(&self, pair: &ChannelPair) -> Option<(usize, &ColumnEntry)> {
        self.entries.iter().enumerate().find(|(_, entry)| entry.name.is_none() && entry.pair == *pair)
    }

    /// The entry of a file with one FRF: one by the file's name, with or without its folder, else one without
    /// name.
    pub(crate) fn of_file(&self, file: &str) -> Option<(usize, &ColumnEntry)> {
        let last = file.rsplit(['/', '\\']).next().unwrap_or(file);
        let nameless = || self.entries.iter().enumerate().find(|(_, entry)| entry.name.is_none());
        self.of_name(file).or_else(|| self.of_name(last)).or_else(nameless)
    }
}

impl ColumnEntry {
    fn parse(text: &str) -> Result<Self, ColumnMapError> {
        let error = || ColumnMapError(text.to_owned());
        let (name, rest) = match text.rsplit_once('=') {
            Some((name, rest)) if !name.trim().is_empty() => (Some(name.trim().to_owned()), rest),
            Some(_) => return Err(error()),
            None => (None, text),
        };
        let (pair, unit) = match rest.trim().strip_suffix(']') {
            None => (rest, None),
            Some(rest) => {
                let (pair, unit) = rest.split_once('[').ok_or_else(error)?;
                (pair, Some(unit.trim().to_owned()).filter(|unit| !unit.is_empty()))
            }
        };
        let pair = ChannelPair::parse(pair).map_err(|_| error())?;
        Ok(ColumnEntry { name, pair, unit, text: text.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_names_a_column_its_frf_and_its_unit() {
        let map = ColumnMap::parse(["H1=4:+z/1 [m/s^2/N]", "a=b=3/1", "2/1"]).unwrap();
        let [first, second, third] = map.entries() else { panic!("three entries") };
        assert_eq!((first.name.as_deref(), first.unit.as_deref()), (Some("H1"), Some("m/s^2/N")));
        assert_eq!(first.pair.response.direction, 3);
        assert_eq!((second.name.as_deref(), second.unit.as_deref()), (Some("a=b"), None));
        assert_eq!(third.name, None);
        assert_eq!(map.of_name("h1").unwrap().0, 0);
        assert_eq!(map.of_file("folder/x.csv").unwrap().0, 2);
        for bad in ["H1", "=4/1", "H1=4", "H1=4/1 m]"] {
            assert!(ColumnMap::parse([bad]).unwrap_err().to_string().contains("H1=4/1 [m/s^2/N]"), "{bad}");
        }
    }
}
