//! Stand-in for the results panel, with the panel's interface and an empty picture.

pub mod panel {
    //! The results panel.

    use crate::{Figure, PlotError};

    /// An empty figure in place of the panel.
    ///
    /// # Arguments
    /// * `stages` - the simulation's stages
    /// * `channels` - its signals
    ///
    /// # Errors
    /// None yet.
    pub fn draw(
        _stages: &meshtone::Stages,
        _channels: &meshtone::signal::Channels,
    ) -> Result<Figure, PlotError> {
        Ok(Figure { svg: "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1\" height=\"1\"/>".into() })
    }
}

/// A figure.
#[derive(Debug, Clone)]
pub struct Figure {
    svg: String,
}

/// A figure that could not be drawn.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw")]
pub struct PlotError;

impl Figure {
    /// The figure as SVG.
    pub fn svg(&self) -> &str {
        &self.svg
    }

    /// The figure as PNG.
    ///
    /// # Errors
    /// None yet.
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        Ok(b"\x89PNG\r\n\x1a\n".to_vec())
    }
}
