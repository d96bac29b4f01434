//! The joints that the arguments of `compare` name: directories of decompositions, and joints of them.

use std::path::{Path, PathBuf};

use jointscope::comparison::{Decomposed, Source};

use crate::input;
use crate::refusal::Refusal;

/// What a decomposition wrote.
const FILE: &str = "stiffness.json";

/// What was named: directories, and of those with several joints perhaps one.
#[derive(Debug, Default)]
pub(super) struct Listed {
    named: Vec<Named>,
    /// The first and the second time that something was named.
    twice: Option<[PathBuf; 2]>,
}

#[derive(Debug)]
struct Named {
    /// As it was given.
    path: PathBuf,
    directory: PathBuf,
    /// One joint of several.
    joint: Option<String>,
}

/// The joints in the order that they were named.
pub(super) struct Found {
    pub joints: Vec<Decomposed>,
    /// Places of the joints that each name stands for.
    places: Vec<Vec<usize>>,
}

impl Listed {
    /// Adds what a path names, unless it is there already; its place.
    pub(super) fn add(&mut self, path: &Path) -> usize {
        let named = Named::of(path);
        if let Some(place) = self.named.iter().position(|other| other.is_same(&named)) {
            self.twice.get_or_insert_with(|| [self.named[place].path.clone(), named.path]);
            return place;
        }
        self.named.push(named);
        self.named.len() - 1
    }

    /// What was named twice, under one name or two.
    pub(super) fn given_twice(&self) -> Option<&[PathBuf; 2]> {
        self.twice.as_ref()
    }

    /// The files to be read, each once. Of what is not there at all reading tells.
    pub(super) fn files(&self) -> Result<Vec<PathBuf>, Refusal> {
        let mut files: Vec<PathBuf> = Vec::new();
        for named in &self.named {
            let file = named.directory.join(FILE);
            if named.directory.is_file() {
                return Err(Refusal::at(
                    &named.directory,
                    "is a file where a directory is needed; give the one that `jointscope decompose` wrote to",
                ));
            }
            if named.directory.is_dir() && !file.exists() {
                return Err(Refusal::holding_no(&named.directory, FILE, "decompose"));
            }
            if !files.iter().any(|other| is_same(other, &file)) {
                files.push(file);
            }
        }
        Ok(files)
    }

    /// Reads them, each file once. A joint named by itself and with all of its directory is there once.
    pub(super) fn read(&self) -> Result<Found, Refusal> {
        let mut found = Found { joints: Vec::new(), places: Vec::new() };
        let files = self.files()?;
        let contents = files.iter().map(|file| input::json(file)).collect::<Result<Vec<_>, _>>()?;
        for named in &self.named {
            let file = named.directory.join(FILE);
            let Some((_, contents)) = files.iter().zip(&contents).find(|(other, _)| is_same(other, &file))
            else {
                continue;
            };
            let refused = |error| Refusal::at(&file, error);
            let name = self.name(named);
            let all = match &named.joint {
                None => Decomposed::all(name, contents).map_err(refused)?,
                Some(joint) => vec![Decomposed::one(name, contents, joint).map_err(refused)?],
            };
            let places = all.into_iter().map(|joint| {
                let place = found.joints.iter().position(|other| other.name == joint.name);
                place.unwrap_or_else(|| {
                    found.joints.push(joint);
                    found.joints.len() - 1
                })
            });
            let places = places.collect();
            found.places.push(places);
        }
        Ok(found)
    }

    /// The directory's last name, the whole path where another directory shares it; with the joint behind it
    /// where one is named.
    fn name(&self, named: &Named) -> String {
        let short = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
        let own = short(&named.directory);
        let is_alone = self
            .named
            .iter()
            .all(|other| is_same(&other.directory, &named.directory) || short(&other.directory) != own);
        let name = own.filter(|_| is_alone).unwrap_or_else(|| named.directory.display().to_string());
        match &named.joint {
            Some(joint) => format!("{name}/{joint}"),
            None => name,
        }
    }
}

impl Found {
    /// Places of the joints that a name stands for.
    pub(super) fn of(&self, place: usize) -> impl Iterator<Item = usize> + '_ {
        self.places.get(place).into_iter().flatten().copied()
    }

    /// Says what the joints are of that a name stands for; refuses a joint of which it is said already, by
    /// itself and with all of its directory.
    pub(super) fn say(&mut self, place: usize, source: Source) -> Result<(), Refusal> {
        for &joint in self.places.get(place).into_iter().flatten() {
            let joint = &mut self.joints[joint];
            if joint.source.replace(source).is_some() {
                return Err(Refusal::new(format!(
                    "`--as` names `{}` twice, by itself and with its directory: say once what it is of",
                    joint.name
                )));
            }
        }
        Ok(())
    }
}

impl Named {
    /// A directory with a decomposition, or such a directory and a joint in it.
    fn of(path: &Path) -> Self {
        let named = |directory: &Path, joint: Option<String>| Named {
            path: path.to_owned(),
            directory: directory.to_owned(),
            joint,
        };
        if path.join(FILE).exists() {
            return named(path, None);
        }
        let parent = path.parent().filter(|parent| !path.exists() && parent.join(FILE).exists());
        match (parent, path.file_name()) {
            (Some(parent), Some(joint)) => named(parent, Some(joint.to_string_lossy().into_owned())),
            _ => named(path, None),
        }
    }

    fn is_same(&self, other: &Named) -> bool {
        self.joint == other.joint && is_same(&self.directory, &other.directory)
    }
}

/// Whether two paths lead to one directory.
fn is_same(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.components().collect());
    whole(a) == whole(b)
}
