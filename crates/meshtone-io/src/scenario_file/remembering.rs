//! Which files a scenario names.

use std::cell::RefCell;
use std::path::PathBuf;

use meshtone::scenario::{
    FileProblem, FrequencyResponse, Profile, ProfileErrors, ScenarioFiles, WheelDeviations,
};

use super::FilesBeside;

/// Files beside a scenario, and which of them it asked for.
pub(super) struct Remembering<'f> {
    files: &'f FilesBeside,
    asked: RefCell<Vec<PathBuf>>,
}

impl<'f> Remembering<'f> {
    pub(super) fn new(files: &'f FilesBeside) -> Self {
        Self { files, asked: RefCell::default() }
    }

    /// The files that were asked for.
    pub(super) fn read(&self) -> Vec<PathBuf> {
        self.asked.borrow().clone()
    }

    fn remember(&self, name: &str) {
        self.asked.borrow_mut().push(self.files.path_of(name));
    }
}

impl ScenarioFiles for Remembering<'_> {
    fn profile_errors(&self, name: &str) -> Result<ProfileErrors, FileProblem> {
        self.remember(name);
        self.files.profile_errors(name)
    }

    /// From the file that the profile errors are from.
    fn wheel_deviations(&self, name: &str) -> Result<[WheelDeviations; 2], FileProblem> {
        self.files.wheel_deviations(name)
    }

    fn profile(&self, name: &str) -> Result<Profile, FileProblem> {
        self.remember(name);
        self.files.profile(name)
    }

    fn frequency_response(&self, name: &str) -> Result<FrequencyResponse, FileProblem> {
        self.remember(name);
        self.files.frequency_response(name)
    }
}
