//! Pictures of few colours as PNG.

use crate::PlotError;
use crate::drawing::Colour;
use crate::raster::Picture;

/// Encodes pixels with a palette.
///
/// # Arguments
/// * `picture` - the pixels
/// * `text` - a keyword and the text that is to stand in the file under it
pub(crate) fn encode(picture: &Picture, text: Option<(&str, &str)>) -> Result<Vec<u8>, PlotError> {
    let Indexed { palette, pixels } = Indexed::new(&picture.pixels);
    let mut file = Vec::with_capacity(1 << 18);
    let mut encoder = png::Encoder::new(&mut file, picture.width, picture.height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette);
    // Most rows are the row above: its difference is zeros, which even the fastest compression makes short.
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Up);
    if let Some((keyword, text)) = text {
        encoder.add_text_chunk(keyword.to_owned(), text.to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixels)?;
    writer.finish()?;
    Ok(file)
}

/// A picture of at most 256 colours.
struct Indexed {
    /// Red, green and blue of each colour.
    palette: Vec<u8>,
    pixels: Vec<u8>,
}

/// Number of cells that the colours are sorted into: five bits of each of red, green and blue.
const CELLS: usize = 1 << 15;
const MOST_COLOURS: usize = 256;

/// Colours that share a cell.
#[derive(Clone, Copy, Default)]
struct Cell {
    count: u64,
    sum: [u64; 3],
}

impl Cell {
    fn mean(&self) -> [u8; 3] {
        self.sum.map(|sum| ((sum + self.count / 2) / self.count.max(1)) as u8)
    }
}

impl Indexed {
    /// Keeps the 256 most frequent cells; the rare shades of smoothed edges go to the nearest of them.
    fn new(picture: &[Colour]) -> Self {
        let mut cells = vec![Cell::default(); CELLS];
        // Run by run: most pixels are like the one before.
        for run in picture.chunk_by(PartialEq::eq) {
            let (cell, length) = (&mut cells[cell_of(run[0])], run.len() as u64);
            cell.count += length;
            for (sum, value) in cell.sum.iter_mut().zip(run[0].rgb()) {
                *sum += length * u64::from(value);
            }
        }
        let mut used: Vec<usize> = (0..CELLS).filter(|&cell| cells[cell].count > 0).collect();
        used.sort_by_key(|&cell| std::cmp::Reverse(cells[cell].count));
        let colours: Vec<[u8; 3]> = used.iter().take(MOST_COLOURS).map(|&cell| cells[cell].mean()).collect();
        let mut index_of = vec![0u8; CELLS];
        for (place, &cell) in used.iter().enumerate() {
            let index = if place < MOST_COLOURS { place } else { nearest(&colours, cells[cell].mean()) };
            index_of[cell] = index as u8;
        }
        let mut pixels = Vec::with_capacity(picture.len());
        for run in picture.chunk_by(PartialEq::eq) {
            pixels.resize(pixels.len() + run.len(), index_of[cell_of(run[0])]);
        }
        Self { palette: colours.into_flattened(), pixels }
    }
}

fn cell_of(colour: Colour) -> usize {
    let [red, green, blue] = colour.rgb().map(|value| usize::from(value >> 3));
    red << 10 | green << 5 | blue
}

fn nearest(colours: &[[u8; 3]], wanted: [u8; 3]) -> usize {
    let distance = |colour: &[u8; 3]| -> i32 {
        colour.iter().zip(wanted).map(|(&a, b)| (i32::from(a) - i32::from(b)).pow(2)).sum()
    };
    (0..colours.len()).min_by_key(|&index| distance(&colours[index])).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_kept_exactly() {
        let picture = [0xff_ff_ff, 0x00_72_b2, 0xff_ff_ff, 0xd5_5e_00].map(Colour);
        let Indexed { palette, pixels } = Indexed::new(&picture);
        let colours: Vec<&[u8]> =
            pixels.iter().map(|&index| &palette[3 * usize::from(index)..][..3]).collect();
        assert_eq!(colours, [[255, 255, 255], [0, 114, 178], [255, 255, 255], [213, 94, 0]]);
    }

    #[test]
    fn many_colours_go_to_near_ones() {
        let picture: Vec<Colour> = (0..4096u32)
            .map(|k| Colour(0x11_00_00 * (k % 16) + 0x00_11_00 * (k / 16 % 16) + 0x00_00_11 * (k / 256)))
            .collect();
        let Indexed { palette, pixels } = Indexed::new(&picture);
        assert_eq!((palette.len(), pixels.len()), (768, 4096));
    }
}
