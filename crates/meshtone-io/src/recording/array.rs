//! Arrays of numbers, read as channels.

use std::io::{self, Read};

use super::number::Numbers;

/// More columns than any recording has; an array that is wider is no recording.
const MAX_CHANNELS: u64 = 4096;
/// Bytes that are read at once.
const BLOCK_BYTES: usize = 1 << 18;

/// How an array holds channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ArrayLayout {
    pub channels: usize,
    pub samples: u64,
    /// The channels' samples alternate, rather than one channel standing behind the other.
    pub interleaved: bool,
}

impl ArrayLayout {
    /// The layout of an array of one or two dimensions: the longer one is time, the first of equal ones.
    ///
    /// # Arguments
    /// * `shape` - elements along each dimension
    /// * `first_runs_fastest` - whether neighbours in the first dimension are neighbours in the file
    ///   (Fortran, MATLAB), or those in the last (C)
    pub(super) fn of_shape(shape: &[u64], first_runs_fastest: bool) -> Result<ArrayLayout, String> {
        let long: Vec<u64> = shape.iter().copied().filter(|length| *length != 1).collect();
        let (rows, columns) = match long[..] {
            [] => (1, 1),
            [rows] => (rows, 1),
            [rows, columns] => (rows, columns),
            _ => {
                return Err(format!(
                    "an array of shape {}; must have one or two dimensions",
                    shape_text(shape)
                ));
            }
        };
        let channels = rows.min(columns);
        if channels == 0 {
            return Err(format!("an empty array ({})", shape_text(shape)));
        }
        if channels > MAX_CHANNELS {
            let shape = shape_text(shape);
            return Err(format!("an array of shape {shape}, which is more than {MAX_CHANNELS} channels"));
        }
        let channels_in_columns = columns <= rows;
        Ok(ArrayLayout {
            channels: channels as usize,
            samples: rows.max(columns),
            interleaved: channels > 1 && channels_in_columns != first_runs_fastest,
        })
    }
}

/// A shape in words, such as `1000 × 4`.
pub(super) fn shape_text(shape: &[u64]) -> String {
    let lengths: Vec<String> = shape.iter().map(u64::to_string).collect();
    if lengths.is_empty() { "1".to_string() } else { lengths.join(" × ") }
}

/// Reads the wanted channels of an array.
///
/// # Arguments
/// * `from` - the array's bytes
/// * `layout`, `numbers` - how they are to be read
/// * `wanted` - for each channel, whether it is read
/// * `present_bytes` - bytes that are surely there: memory for more is taken only as they come
pub(super) fn read_channels(
    from: &mut dyn Read,
    layout: ArrayLayout,
    numbers: Numbers,
    wanted: &[bool],
    present_bytes: u64,
) -> io::Result<Vec<Vec<f64>>> {
    let ArrayLayout { channels, samples, interleaved } = layout;
    let element = numbers.element_bytes();
    let sure = present_bytes / (element * channels) as u64;
    let mut columns = vec![Vec::new(); channels];
    let wanted_columns = columns.iter_mut().zip(wanted).filter(|(_, wanted)| **wanted);
    wanted_columns.for_each(|(column, _)| column.reserve_exact(samples.min(sure) as usize));
    if interleaved {
        read_records(from, element * channels, samples, |block| {
            for (channel, column) in columns.iter_mut().enumerate().filter(|(channel, _)| wanted[*channel]) {
                numbers.append(block, channels, channel, column);
            }
        })?;
    } else {
        let behind_last = wanted.iter().rposition(|wanted| *wanted).map_or(0, |last| last + 1);
        for (column, wanted) in columns.iter_mut().zip(wanted).take(behind_last) {
            if *wanted {
                read_records(from, element, samples, |block| numbers.append(block, 1, 0, column))?;
            } else {
                skip(from, samples * element as u64)?;
            }
        }
    }
    Ok(columns.into_iter().zip(wanted).filter_map(|(column, wanted)| wanted.then_some(column)).collect())
}

/// Hands over a number of records, as many at a time as fit into a block.
///
/// # Arguments
/// * `from` - their bytes
/// * `record` - bytes of one
/// * `count` - how many there are
/// * `take` - is given whole records
pub(crate) fn read_records(
    from: &mut dyn Read,
    record: usize,
    count: u64,
    mut take: impl FnMut(&[u8]),
) -> io::Result<()> {
    let at_once = ((BLOCK_BYTES / record).max(1) as u64).min(count) as usize;
    let mut block = vec![0; at_once * record];
    let mut left = count;
    while left > 0 {
        let now = left.min(at_once as u64);
        let bytes = &mut block[..now as usize * record];
        from.read_exact(bytes)?;
        take(bytes);
        left -= now;
    }
    Ok(())
}

/// Skips bytes; fewer are an error.
pub(super) fn skip(from: &mut dyn Read, bytes: u64) -> io::Result<()> {
    let skipped = io::copy(&mut from.take(bytes), &mut io::sink())?;
    if skipped < bytes { Err(io::ErrorKind::UnexpectedEof.into()) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::ArrayLayout;

    #[test]
    fn the_longer_dimension_is_time() {
        let layout = |shape: &[u64], fastest| ArrayLayout::of_shape(shape, fastest).unwrap();
        let expect = |channels, samples, interleaved| ArrayLayout { channels, samples, interleaved };
        assert_eq!(layout(&[10], false), expect(1, 10, false));
        assert_eq!(layout(&[1, 10], true), expect(1, 10, false));
        assert_eq!(layout(&[10, 3], false), expect(3, 10, true));
        assert_eq!(layout(&[10, 3], true), expect(3, 10, false));
        assert_eq!(layout(&[3, 10], false), expect(3, 10, false));
        assert_eq!(layout(&[3, 10], true), expect(3, 10, true));
        assert_eq!(layout(&[3, 3], false), expect(3, 3, true));
        assert!(ArrayLayout::of_shape(&[0], false).is_err());
        assert!(ArrayLayout::of_shape(&[2, 3, 4], false).is_err());
        assert!(ArrayLayout::of_shape(&[1 << 40, 1 << 20], false).is_err());
    }
}
