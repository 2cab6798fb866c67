//! Power of a signal by frequency and by what it belongs to in the mesh: cells.

use std::collections::BTreeMap;

use meshtone_fourier::{hann_window, real_spectrum};

use super::recording::Piece;
use crate::signal::GearTrain;

/// Steps of the frequencies in an octave, where the window resolves them, and where nothing is compared.
const STEPS_PER_OCTAVE: f64 = 48.0;
const STEPS_OUTSIDE: f64 = 6.0;
/// Frequencies below those that are compared.
const POINTS_BELOW: usize = 12;
/// (lines) How near a mesh harmonic a line belongs to it: the main lobe of Hann's window.
const NEAR_LINES: f64 = 2.0;
/// (orders of a mesh's faster shaft) Beside a mesh harmonic, what belongs to its sidebands.
const SIDEBAND_ORDERS: f64 = 3.5;
/// Mesh harmonics that are told apart.
const MOST_HARMONICS: usize = 60;
/// Frequencies on either side of one over which noise is taken to be the same: no more, since a notch of the path would be taken for noise.
const AROUND: usize = 2;
/// (-) Part of the lowest mesh frequency from which on lines are compared.
const FROM_MESH: f64 = 0.5;

/// What a line belongs to.
///
/// The wheels decide how strong each is, so that a recording may differ in each from the mean of the simulations, alike at all frequencies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum LineKind {
    /// The harmonic of this number of a mesh, which comes first.
    Harmonic(usize, usize),
    /// The sidebands around it.
    Sidebands(usize, usize),
    /// The broad-band remainder around the harmonic of this number of the first mesh.
    Remainder(usize),
}

/// Sorts of kinds.
pub(super) const SORTS: usize = 3;

impl LineKind {
    /// Its sort: mesh harmonics, sidebands, remainder.
    pub(super) fn sort(self) -> usize {
        match self {
            Self::Harmonic(..) => 0,
            Self::Sidebands(..) => 1,
            Self::Remainder(_) => 2,
        }
    }
}

/// Lines of one kind around one frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Cell {
    /// Place of the frequency among those of the path.
    pub frequency: usize,
    /// What the lines belong to.
    pub kind: LineKind,
}

/// The orders of a mesh, of the pinion's shaft or the input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MeshOrders {
    /// (orders) The mesh itself.
    pub mesh: f64,
    /// (orders) The faster one of its two shafts.
    pub shaft: f64,
}

impl MeshOrders {
    /// All meshes of a train.
    pub(super) fn of(train: &GearTrain) -> Vec<Self> {
        let faster = |mesh: [usize; 2]| {
            let speeds = mesh.map(|wheel| train.shafts[train.wheels[wheel].shaft].speed_ratio.value());
            speeds[0].max(speeds[1])
        };
        let orders = |(number, mesh): (usize, &[usize; 2])| Self {
            mesh: train.mesh_order(number),
            shaft: faster(*mesh),
        };
        train.meshes.iter().enumerate().map(orders).collect()
    }

    /// (orders) The slowest mesh.
    pub(super) fn slowest(meshes: &[Self]) -> f64 {
        meshes.iter().map(|of| of.mesh).fold(f64::INFINITY, f64::min)
    }
}

/// The cells of some pieces of recordings, and which lines of which spectra fall into each.
pub(super) struct Cells {
    /// (Hz) Rising frequencies at which the path is estimated: those that are compared, and some outside.
    pub frequency_hz: Vec<f64>,
    /// (Hz) The lowest and the highest frequency that are compared.
    pub compared_hz: [f64; 2],
    /// The cells that have lines.
    pub cells: Vec<Cell>,
    /// Of each piece, the lines of each cell.
    pub lines: Vec<Vec<f64>>,
    /// (s) Length of a window.
    window_s: f64,
    /// Of each piece, of each window, the cell of each line from the first that is compared on.
    cell_of: Vec<Vec<Vec<usize>>>,
    first_line: usize,
    /// The place of each line's frequency, from the first line that is compared on.
    frequency_of: Vec<usize>,
}

impl Cells {
    /// Sorts the lines of all windows.
    ///
    /// # Arguments
    /// * `pieces` - of recordings
    /// * `window_s` - (s) length of a window
    /// * `most_hz` - (Hz) highest frequency that is compared
    /// * `end_hz` - (Hz) last frequency of the path
    /// * `meshes` - all of the machine
    pub(super) fn new(
        pieces: &[Piece],
        window_s: f64,
        [most_hz, end_hz]: [f64; 2],
        meshes: &[MeshOrders],
    ) -> Self {
        let slowest_order = MeshOrders::slowest(meshes);
        let speeds = pieces.iter().flat_map(|piece| piece.speed_hz.value.iter().copied());
        let slowest_mesh_hz = slowest_order * speeds.fold(f64::INFINITY, f64::min);
        let first_line = (FROM_MESH * slowest_mesh_hz * window_s).ceil().max(2.0) as usize;
        let last_line = (most_hz * window_s) as usize;
        let [first_hz, last_hz] = [first_line, last_line].map(|line| line as f64 / window_s);
        let (frequency_hz, compared_hz) = frequencies([first_hz, last_hz], end_hz, 1.0 / window_s);
        let nearest = |hz: f64| {
            let above = frequency_hz.partition_point(|&point| point < hz).min(frequency_hz.len() - 1);
            let below = above.saturating_sub(1);
            if frequency_hz[above] - hz < hz - frequency_hz[below] { above } else { below }
        };
        let frequency_of: Vec<usize> =
            (first_line..=last_line).map(|line| nearest(line as f64 / window_s)).collect();
        let mut known: BTreeMap<Cell, usize> = BTreeMap::new();
        let mut cells = Vec::new();
        let mut of_window = |piece: &Piece, window: usize| -> Vec<usize> {
            let speed_hz = |part: f64| piece.speed_hz.at((window as f64 * 0.5 + part) * window_s);
            let [start, middle, end] = [0.0, 0.5, 1.0].map(speed_hz);
            let cell_of = |(line, &frequency): (usize, &usize)| {
                let hz = (first_line + line) as f64 / window_s;
                let kind = line_kind(hz, [middle, (end - start).abs()], meshes, window_s);
                *known.entry(Cell { frequency, kind }).or_insert_with(|| {
                    cells.push(Cell { frequency, kind });
                    cells.len() - 1
                })
            };
            frequency_of.iter().enumerate().map(cell_of).collect()
        };
        let cell_of: Vec<Vec<Vec<usize>>> = pieces
            .iter()
            .map(|piece| (0..windows(piece, window_s)).map(|window| of_window(piece, window)).collect())
            .collect();
        let count = |of_piece: &Vec<Vec<usize>>| {
            let mut lines = vec![0.0; cells.len()];
            of_piece.iter().flatten().for_each(|&cell| lines[cell] += 1.0);
            lines
        };
        let lines = cell_of.iter().map(count).collect();
        Self { frequency_hz, compared_hz, lines, cells, window_s, cell_of, first_line, frequency_of }
    }

    /// (g²/Hz) Power density of the lines of each window of a piece, from the first line that is compared on.
    ///
    /// # Arguments
    /// * `piece` - number of the piece
    /// * `values` - (g) its samples, recorded or simulated
    /// * `sampling_rate_hz` - (S/s)
    pub(super) fn spectra(&self, piece: usize, values: &[f64], sampling_rate_hz: f64) -> Vec<Vec<f64>> {
        let length = (self.window_s * sampling_rate_hz).round() as usize;
        let hann = hann_window(length);
        let scale = 1.0 / (sampling_rate_hz * hann.iter().map(|weight| weight * weight).sum::<f64>());
        let spectrum = |window: usize| {
            let start = (window as f64 * 0.5 * self.window_s * sampling_rate_hz).round() as usize;
            let start = start.min(values.len().saturating_sub(length));
            let windowed: Vec<f64> =
                values[start..].iter().zip(&hann).map(|(value, weight)| value * weight).collect();
            let lines = real_spectrum(&windowed).into_iter().skip(self.first_line);
            lines.take(self.frequency_of.len()).map(|line| scale * line.norm_sqr()).collect()
        };
        (0..self.cell_of[piece].len()).map(spectrum).collect()
    }

    /// (g²/Hz) Sum of the power density of the lines of each cell.
    ///
    /// # Arguments
    /// * `piece` - number of the piece
    /// * `spectra` - of its windows
    pub(super) fn powers(&self, piece: usize, spectra: &[Vec<f64>]) -> Vec<f64> {
        let mut powers = vec![0.0; self.cells.len()];
        for (cell_of, spectrum) in self.cell_of[piece].iter().zip(spectra) {
            cell_of.iter().zip(spectrum).for_each(|(&cell, power)| powers[cell] += power);
        }
        powers
    }

    /// (g²/Hz) Mean power density around each frequency in some windows; infinite far from those that are compared.
    ///
    /// # Arguments
    /// * `spectra` - of the windows
    pub(super) fn around_frequencies(&self, spectra: &[Vec<f64>]) -> Vec<f64> {
        let mut sums = vec![[0.0; 2]; self.frequency_hz.len() + 1];
        for (&frequency, power) in spectra.iter().flat_map(|spectrum| self.frequency_of.iter().zip(spectrum))
        {
            let [sum, count] = &mut sums[frequency + 1];
            *sum += power;
            *count += 1.0;
        }
        for at in 1..sums.len() {
            let before = sums[at - 1];
            sums[at].iter_mut().zip(before).for_each(|(sum, before)| *sum += before);
        }
        let last = self.frequency_hz.len();
        let mean = |at: usize| {
            let (from, to) = (sums[at.saturating_sub(AROUND)], sums[(at + AROUND + 1).min(last)]);
            if to[1] > from[1] { (to[0] - from[0]) / (to[1] - from[1]) } else { f64::INFINITY }
        };
        (0..last).map(mean).collect()
    }
}

/// Windows in a piece, each half on the one before.
fn windows(piece: &Piece, window_s: f64) -> usize {
    (2.0 * (piece.length_s / window_s) - 1.0 + 1e-9) as usize
}

/// (Hz) Frequencies from below those that are compared to the end, as close as the octave is divided, but not closer than the window
/// resolves; and the first and the last that are compared.
fn frequencies([from_hz, to_hz]: [f64; 2], end_hz: f64, resolved_hz: f64) -> (Vec<f64>, [f64; 2]) {
    let ratio = libm::exp2(1.0 / STEPS_PER_OCTAVE);
    let next = |hz: &f64| Some((hz * ratio).max(hz + resolved_hz)).filter(|hz| *hz <= to_hz);
    let compared: Vec<f64> = std::iter::successors(Some(from_hz), next).collect();
    let last_hz = compared.last().copied().unwrap_or(from_hz);
    let ratio = libm::exp2(1.0 / STEPS_OUTSIDE);
    let below = (1..=POINTS_BELOW).rev().map(|step| from_hz / ratio.powi(step as i32));
    let above = std::iter::successors(Some(last_hz * ratio), |hz| Some(hz * ratio));
    let above = above.take_while(|hz| hz * ratio < end_hz).chain([end_hz]);
    (below.chain(compared).chain(above).collect(), [from_hz, last_hz])
}

/// What a line belongs to: the nearest harmonic of any mesh, the sidebands of the nearest one, or the remainder.
///
/// # Arguments
/// * `hz` - (Hz) its frequency
/// * `speed_hz` - (Hz) of the pinion or the input: the mean in the window, and by how much it changes there
/// * `meshes` - all of the machine
/// * `window_s` - (s) length of the window
fn line_kind(hz: f64, [speed_hz, change_hz]: [f64; 2], meshes: &[MeshOrders], window_s: f64) -> LineKind {
    // Of each mesh the number of the nearest harmonic, how far that is, and how far harmonic and sidebands reach.
    let nearest = meshes.iter().enumerate().map(|(mesh, orders)| {
        let mesh_hz = orders.mesh * speed_hz;
        let harmonic = (hz / mesh_hz).round();
        let near_hz = NEAR_LINES / window_s + 0.5 * harmonic * orders.mesh * change_hz;
        // Where the speed changes so much that neighbours run into each other nothing is told apart.
        let is_told = (1.0..=MOST_HARMONICS as f64).contains(&harmonic) && near_hz <= 0.25 * mesh_hz;
        let beside_hz = near_hz + SIDEBAND_ORDERS * orders.shaft * speed_hz;
        (is_told, (hz - harmonic * mesh_hz).abs(), [near_hz, beside_hz], mesh, harmonic as usize)
    });
    let told = nearest.clone().filter(|(is_told, ..)| *is_told).min_by(|a, b| a.1.total_cmp(&b.1));
    let around = nearest.map(|(.., number)| number.min(MOST_HARMONICS)).next().unwrap_or(0);
    match told {
        Some((_, from_hz, [near_hz, _], mesh, number)) if from_hz <= near_hz => {
            LineKind::Harmonic(mesh, number)
        }
        Some((_, from_hz, [_, beside_hz], mesh, number)) if from_hz <= beside_hz => {
            LineKind::Sidebands(mesh, number)
        }
        _ => LineKind::Remainder(around),
    }
}
