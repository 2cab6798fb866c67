//! Reading a table.

use std::sync::Arc;

use parquet::column::page::PageReader;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData};
use parquet::file::reader::{ChunkReader, SerializedPageReader};
use parquet::schema::types::Type;

use super::arrow_schema::{self, ArrowField};
use super::page_checksum::{self, CheckedPages};
use super::{FoundType, NumberType, metadata_hash};

/// Rows that are decoded at once.
const ROWS_AT_ONCE: usize = 1 << 14;

/// A table that is read.
pub struct TableReader<R: ChunkReader + 'static> {
    file: Arc<R>,
    metadata: ParquetMetaData,
    columns: Vec<FoundColumn>,
    /// Checksums of the headers of pages, by columns in groups of rows.
    headers: Vec<Vec<u32>>,
}

/// A column of a table that is read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FoundColumn {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub kind: FoundType,
    /// Whether cells may be empty.
    pub nullable: bool,
    /// What Arrow's schema says of it: keys and values.
    pub metadata: Vec<(String, String)>,
    /// Number of its first column of single values: Parquet stores what a column is made of apart.
    leaf: usize,
}

/// The numbers of a column.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Numbers {
    /// Each row's; NaN where the cell is empty.
    pub values: Vec<f64>,
    /// The first row whose cell is empty.
    pub first_empty: Option<usize>,
}

impl<R: ChunkReader + 'static> TableReader<R> {
    /// Opens a table.
    ///
    /// # Arguments
    /// * `file` - the Parquet file
    ///
    /// # Errors
    /// The file cannot be read, is no Parquet file, or has other metadata than were written.
    pub fn new(file: R) -> Result<Self> {
        let metadata = metadata_hash::read(&file)?;
        let mut table = Self { file: Arc::new(file), metadata, columns: Vec::new(), headers: Vec::new() };
        let arrow = table.text_of(arrow_schema::KEY).and_then(arrow_schema::decode).unwrap_or_default();
        table.headers = table.text_of(page_checksum::KEY).map(page_checksum::of_headers).unwrap_or_default();
        table.columns = columns(table.metadata().file_metadata().schema(), &arrow);
        Ok(table)
    }

    /// What the file says about itself under a key.
    ///
    /// # Arguments
    /// * `key` - the key
    pub fn text_of(&self, key: &str) -> Option<&str> {
        let entries = self.metadata().file_metadata().key_value_metadata().into_iter().flatten();
        entries.filter(|entry| entry.key == key).find_map(|entry| entry.value.as_deref())
    }

    /// What the file says about itself.
    pub fn metadata(&self) -> &ParquetMetaData {
        &self.metadata
    }

    /// The columns, in the file's order.
    pub fn columns(&self) -> &[FoundColumn] {
        &self.columns
    }

    /// The column of a name.
    ///
    /// # Arguments
    /// * `name` - the name
    pub fn column(&self, name: &str) -> Option<&FoundColumn> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// What the file says of a column's chunks, one in each group of rows.
    ///
    /// # Arguments
    /// * `column` - of this table
    pub fn chunks(&self, column: &FoundColumn) -> impl Iterator<Item = &ColumnChunkMetaData> {
        let leaf = column.leaf;
        self.metadata.row_groups().iter().filter_map(move |group| group.columns().get(leaf))
    }

    /// Reads a column of numbers, or of moments as seconds since the first.
    ///
    /// # Arguments
    /// * `column` - of this table
    /// * `capacity` - numbers for which memory is taken beforehand
    ///
    /// # Errors
    /// The file cannot be read; the column holds something else.
    pub fn numbers(&self, column: &FoundColumn, capacity: usize) -> Result<Numbers> {
        let mut numbers = Numbers { values: Vec::with_capacity(capacity), ..Numbers::default() };
        let mut first = None;
        // An integer of the file, as one with sign and as one without.
        let mut whole = |signed: i64, unsigned: u64| match column.kind {
            FoundType::Moment { per_second } => seconds(signed, &mut first, per_second),
            FoundType::Number(NumberType::UInt(_)) => unsigned as f64,
            _ => signed as f64,
        };
        self.each_group(column, |reader| match (reader, column.kind) {
            (_, FoundType::Text | FoundType::Other(_)) => Err(holds(column)),
            (ColumnReader::DoubleColumnReader(reader), FoundType::Number(_)) => {
                numbers.append(reader, column, |&number| number)
            }
            (ColumnReader::FloatColumnReader(reader), FoundType::Number(_)) => {
                numbers.append(reader, column, |&number| f64::from(number))
            }
            (ColumnReader::Int32ColumnReader(reader), _) => {
                numbers.append(reader, column, |&number| whole(number.into(), number.cast_unsigned().into()))
            }
            (ColumnReader::Int64ColumnReader(reader), _) => {
                numbers.append(reader, column, |&number| whole(number, number.cast_unsigned()))
            }
            (ColumnReader::Int96ColumnReader(reader), FoundType::Moment { .. }) => {
                numbers.append(reader, column, |moment| whole(moment.to_nanos(), 0))
            }
            _ => Err(holds(column)),
        })?;
        Ok(numbers)
    }

    /// Reads a column of text; none where a cell is empty.
    ///
    /// # Arguments
    /// * `column` - of this table
    ///
    /// # Errors
    /// The file cannot be read; the column holds something else.
    pub fn texts(&self, column: &FoundColumn) -> Result<Vec<Option<String>>> {
        let mut texts = Vec::new();
        self.each_group(column, |reader| match (reader, column.kind) {
            (ColumnReader::ByteArrayColumnReader(reader), FoundType::Text) => {
                each_block(reader, column.nullable, |values, levels| {
                    let mut values = values.iter();
                    let mut next =
                        || values.next().map(|value| value.as_utf8().map(str::to_owned)).transpose();
                    for row in 0..levels.rows {
                        texts.push(if levels.is_there(row) { next()? } else { None });
                    }
                    Ok(())
                })
            }
            _ => Err(holds(column)),
        })?;
        Ok(texts)
    }

    /// Number of groups of rows.
    pub fn groups(&self) -> usize {
        self.metadata.num_row_groups()
    }

    /// Reads the lists of numbers in a group of rows.
    ///
    /// # Arguments
    /// * `column` - of this table
    /// * `group` - number of the group, from 0
    ///
    /// # Errors
    /// The file cannot be read; the column holds something else; there is no such group.
    pub fn lists(&self, column: &FoundColumn, group: usize) -> Result<Vec<Vec<f64>>> {
        if group >= self.groups() {
            return Err(ParquetError::General(format!(
                "there are {} groups of rows, not {}",
                self.groups(),
                group + 1
            )));
        }
        let rows = usize::try_from(self.metadata.row_group(group).num_rows()).unwrap_or(0);
        match self.column_reader(column, group)? {
            ColumnReader::FloatColumnReader(reader) => lists_of(reader, rows, |&number| f64::from(number)),
            ColumnReader::DoubleColumnReader(reader) => lists_of(reader, rows, |&number| number),
            ColumnReader::Int32ColumnReader(reader) => lists_of(reader, rows, |&number| f64::from(number)),
            ColumnReader::Int64ColumnReader(reader) => lists_of(reader, rows, |&number| number as f64),
            _ => Err(holds(column)),
        }
    }

    /// Reads the list of numbers in one row, with those of its group of rows.
    ///
    /// # Arguments
    /// * `column` - of this table
    /// * `row` - the row
    ///
    /// # Errors
    /// The file cannot be read; the column holds something else; there is no such row.
    pub fn list(&self, column: &FoundColumn, row: usize) -> Result<Vec<f64>> {
        let mut row = row;
        for (number, group) in self.metadata().row_groups().iter().enumerate() {
            let rows = usize::try_from(group.num_rows()).unwrap_or(0);
            if row < rows {
                let list = self.lists(column, number)?.into_iter().nth(row);
                return list.ok_or_else(|| ParquetError::General("it ends early".to_owned()));
            }
            row -= rows;
        }
        Err(ParquetError::General(format!("there is no row {row} more")))
    }

    /// Reads a column, one group of rows after the other, and checks that each has the rows that the file says.
    fn each_group(
        &self,
        column: &FoundColumn,
        mut read: impl FnMut(ColumnReader) -> Result<usize>,
    ) -> Result<()> {
        for (number, group) in self.metadata.row_groups().iter().enumerate() {
            let (stated, found) = (group.num_rows(), read(self.column_reader(column, number)?)?);
            if usize::try_from(stated) != Ok(found) {
                return Err(ParquetError::General(format!(
                    "column {} has {found} rows in row group {}, not {stated}",
                    column.name,
                    number + 1
                )));
            }
        }
        Ok(())
    }

    /// A reader of a column's part of a group of rows, which compares the checksums.
    fn column_reader(&self, column: &FoundColumn, number: usize) -> Result<ColumnReader> {
        let group = self.metadata.row_group(number);
        let chunk = group.column(column.leaf);
        let rows = usize::try_from(group.num_rows())?;
        let file = Arc::clone(&self.file);
        let pages: Box<dyn PageReader> = match self.headers.get(number * group.num_columns() + column.leaf) {
            Some(headers) => {
                let file = CheckedPages::new(file, headers.clone());
                Box::new(SerializedPageReader::new(Arc::new(file), chunk, rows, None)?)
            }
            None => Box::new(SerializedPageReader::new(file, chunk, rows, None)?),
        };
        Ok(get_column_reader(chunk.column_descr_ptr(), pages))
    }
}

fn holds(column: &FoundColumn) -> ParquetError {
    ParquetError::General(format!("column {} holds {}", column.name, column.kind))
}

/// The columns of a schema. What Arrow says counts where it is about the same columns.
fn columns(schema: &Type, arrow: &[ArrowField]) -> Vec<FoundColumn> {
    let mut leaf = 0;
    let mut columns = Vec::new();
    for (index, column) in schema.get_fields().iter().enumerate() {
        let arrow = arrow.get(index).filter(|field| field.name == column.name());
        columns.push(FoundColumn {
            name: column.name().to_owned(),
            kind: FoundType::of(column, arrow.and_then(|field| field.kind)),
            nullable: column.is_optional(),
            metadata: arrow.map(|field| field.metadata.clone()).unwrap_or_default(),
            leaf,
        });
        leaf += leaves(column);
    }
    columns
}

fn leaves(column: &Type) -> usize {
    if column.is_group() { column.get_fields().iter().map(|part| leaves(part)).sum() } else { 1 }
}

/// Which cells of a block are not empty.
struct Levels<'l> {
    rows: usize,
    /// Of a column whose cells may be empty: 1 where the cell is not.
    definitions: &'l [i16],
}

impl Levels<'_> {
    fn is_there(&self, row: usize) -> bool {
        self.definitions.get(row).is_none_or(|&level| level > 0)
    }
}

/// Reads a column of single values in blocks, and returns how many rows it has.
fn each_block<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    nullable: bool,
    mut block: impl FnMut(&[T::T], Levels) -> Result<()>,
) -> Result<usize> {
    let (mut values, mut definitions) = (Vec::new(), Vec::new());
    let mut all = 0;
    loop {
        values.clear();
        definitions.clear();
        let levels = nullable.then_some(&mut definitions);
        let (rows, ..) = reader.read_records(ROWS_AT_ONCE, levels, None, &mut values)?;
        if rows == 0 {
            return Ok(all);
        }
        block(&values, Levels { rows, definitions: &definitions })?;
        all += rows;
    }
}

/// Reads the lists of a group of rows. An item that is null is left out.
fn lists_of<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    rows: usize,
    number: impl Fn(&T::T) -> f64,
) -> Result<Vec<Vec<f64>>> {
    let (mut values, mut definitions, mut repetitions) = (Vec::new(), Vec::new(), Vec::new());
    let (found, ..) =
        reader.read_records(rows, Some(&mut definitions), Some(&mut repetitions), &mut values)?;
    if found != rows {
        return Err(ParquetError::General(format!("it has {found} lists in a row group of {rows}")));
    }
    let (mut values, mut lists) = (values.iter().map(number), Vec::with_capacity(found));
    // A value is there where its definition level is the highest one, and a list begins where the repetition level is 0.
    let there = definitions.iter().copied().max().unwrap_or(0);
    for (definition, repetition) in definitions.iter().zip(&repetitions) {
        if *repetition == 0 {
            lists.push(Vec::new());
        }
        if let (true, Some(list)) = (*definition == there, lists.last_mut()) {
            list.extend(values.next());
        }
    }
    Ok(lists)
}

/// (s) A moment since the first one, which is kept.
fn seconds(moment: i64, first: &mut Option<i64>, per_second: u32) -> f64 {
    let first = *first.get_or_insert(moment);
    // In 128 bits, as two moments may be farther apart than fits into 64.
    (i128::from(moment) - i128::from(first)) as f64 / f64::from(per_second)
}

impl Numbers {
    fn append<T: DataType>(
        &mut self,
        reader: ColumnReaderImpl<T>,
        column: &FoundColumn,
        mut number: impl FnMut(&T::T) -> f64,
    ) -> Result<usize> {
        each_block(reader, column.nullable, |values, levels| {
            self.values.extend(values.iter().map(&mut number));
            self.spread(values.len(), &levels);
            Ok(())
        })
    }

    /// Puts NaN where cells are empty.
    ///
    /// * `found` - numbers at the end that belong to the cells that are not
    fn spread(&mut self, found: usize, levels: &Levels) {
        if found == levels.rows {
            return;
        }
        let start = self.values.len() - found;
        let mut numbers = self.values.split_off(start).into_iter();
        let cells = (0..levels.rows).map(|row| if levels.is_there(row) { numbers.next() } else { None });
        self.values.extend(cells.map(|cell| cell.unwrap_or(f64::NAN)));
        let empty = (0..levels.rows).find(|&row| !levels.is_there(row)).map(|row| start + row);
        self.first_empty = self.first_empty.or(empty);
    }
}
