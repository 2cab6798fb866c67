//! A finished figure.

use crate::drawing::TextStyle;
use crate::scene::{Element, Scene, ScenePoint};
use crate::{PlotError, palette_png, raster, svg};

/// Name of the run's identity in the files.
const RUN_KEY: &str = "meshtone.run";
/// Element of the SVG before which metadata stand.
const METADATA_BEFORE: &str = "<defs>";

/// A finished figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    scene: Scene,
    svg: String,
    run: Option<String>,
}

/// A text of a figure and the box that it fills when set in the bundled font.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// The text.
    pub text: String,
    /// (px) Left edge, from the figure's left.
    pub left: f64,
    /// (px) Upper edge, from the figure's top.
    pub top: f64,
    /// (px) Right edge.
    pub right: f64,
    /// (px) Lower edge.
    pub bottom: f64,
}

/// Part of the font size by which letters rise above and fall below the baseline.
const ASCENT: f64 = 0.76;
const DESCENT: f64 = 0.22;

impl Label {
    fn new(at: ScenePoint, text: &str, style: TextStyle) -> Self {
        let [x, y] = [at.x, at.y].map(|place| f64::from(place.px()));
        let width = style.width(text);
        let before = style.anchor.before(width);
        let (up, down) = (ASCENT * style.size, DESCENT * style.size);
        let (left, top, right, bottom) = if style.upwards {
            (x - up, y + before - width, x + down, y + before)
        } else {
            (x - before, y - up, x - before + width, y + down)
        };
        Self { text: text.to_owned(), left, top, right, bottom }
    }
}

impl Figure {
    pub(crate) fn new(scene: Scene, title: &str, description: &str) -> Self {
        let svg = svg::document(&scene, title, description);
        Self { scene, svg, run: None }
    }

    /// Returns the figure with the identity of the run that it shows in its files: in the SVG's element `metadata`,
    /// and in the PNG's text `meshtone.run`.
    ///
    /// # Arguments
    /// * `run` - ASCII letters and digits; others are left out
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let mut scenario = Scenario::new(GearPair::example());
    /// scenario.solver.sampling_rate_hz = 2e4;
    /// let simulation = meshtone::simulate(&scenario)?;
    /// let panel = meshtone_plot::panel::draw(&simulation)?.of_run("00ff");
    /// assert!(panel.svg().contains("<metadata>meshtone.run: 00ff</metadata>"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_run(mut self, run: &str) -> Self {
        let run: String = run.chars().filter(char::is_ascii_alphanumeric).collect();
        if let Some(place) = self.svg.find(METADATA_BEFORE) {
            self.svg.insert_str(place, &format!("<metadata>{RUN_KEY}: {run}</metadata>\n"));
        }
        self.run = Some(run);
        self
    }

    /// The figure as an SVG document.
    pub fn svg(&self) -> &str {
        &self.svg
    }

    /// The figure as a PNG file of [`Self::size_px`], which looks as [`Self::svg`] does with the font at hand.
    ///
    /// # Errors
    /// A PNG that cannot be encoded, which no input should bring about.
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        let picture = raster::picture(&self.scene);
        palette_png::encode(&picture, self.run.as_deref().map(|run| (RUN_KEY, run)))
    }

    /// (px) Width and height.
    pub fn size_px(&self) -> (u32, u32) {
        (self.scene.width, self.scene.height)
    }

    /// Every text of the figure and where it is.
    pub fn labels(&self) -> Vec<Label> {
        let label = |element: &Element| match element {
            Element::Text { at, text, style } => Some(Label::new(*at, text, *style)),
            _ => None,
        };
        self.scene.elements.iter().filter_map(label).collect()
    }
}
