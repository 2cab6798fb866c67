//! Nothing: this package's dependencies are its purpose.
