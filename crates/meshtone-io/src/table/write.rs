//! Writing a table.

use std::collections::HashSet;
use std::io::{self, Write};
use std::sync::Arc;

use bytes::Bytes;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::column::writer::{ColumnWriter, get_column_writer, get_typed_column_writer_mut};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int32Type, Int64Type};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};

use super::metadata_hash::{self, HashedMetadata, UNKNOWN_HASH};
use super::page_checksum::{self, ChecksummedPages};
use super::{arrow_schema, into_io, split_signal};

/// Name of the table itself, as Arrow's writers give it.
const TABLE: &str = "arrow_schema";
/// Name of a list's repeated part.
const LIST: &str = "list";
/// Name of what a list consists of.
pub(super) const LIST_ITEM: &str = "item";

/// A column that is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableColumn {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub cells: CellType,
    /// Whether cells may be empty.
    pub nullable: bool,
    /// What Arrow's schema says of it: keys and values, such as `unit` and `Hz`.
    pub metadata: Vec<(String, String)>,
}

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellType {
    /// Integers of 32 bits.
    Int32,
    /// Integers of 64 bits.
    Int64,
    /// Double precision.
    Float64,
    /// Text.
    Text,
    /// Lists of numbers in single precision, none of them empty.
    Float32List,
}

/// The cells of a column in some rows.
pub enum Cells<'c> {
    /// Of [`CellType::Int32`].
    Int32(Vec<Option<i32>>),
    /// Of [`CellType::Int64`].
    Int64(Vec<Option<i64>>),
    /// Of [`CellType::Float64`].
    Float64(Vec<Option<f64>>),
    /// Of [`CellType::Float64`], none of them empty.
    Signal(&'c [f64]),
    /// Of [`CellType::Text`].
    Text(Vec<Option<String>>),
    /// Of [`CellType::Float32List`].
    Float32List(Vec<&'c [f32]>),
}

impl TableColumn {
    /// A column without empty cells, of which Arrow's schema says nothing more.
    ///
    /// # Arguments
    /// * `name`, `cells` - of the column
    pub fn new(name: &str, cells: CellType) -> Self {
        Self { name: name.to_owned(), cells, nullable: false, metadata: Vec::new() }
    }

    /// The column with entries of Arrow's schema.
    ///
    /// # Arguments
    /// * `entries` - keys and values, such as `unit` and `Hz`
    pub fn with_metadata<'m>(mut self, entries: impl IntoIterator<Item = (&'m str, &'m str)>) -> Self {
        self.metadata.extend(entries.into_iter().map(|(key, value)| (key.to_owned(), value.to_owned())));
        self
    }

    /// The column of Parquet's schema. The number of its leaf is that of the column: lists have one leaf too.
    fn schema(&self) -> Result<TypePtr> {
        let repetition = |nullable| if nullable { Repetition::OPTIONAL } else { Repetition::REQUIRED };
        let of = |physical, logical| {
            Type::primitive_type_builder(&self.name, physical)
                .with_logical_type(logical)
                .with_repetition(repetition(self.nullable))
                .build()
        };
        let column = match self.cells {
            CellType::Int32 => of(Physical::INT32, None),
            CellType::Int64 => of(Physical::INT64, None),
            CellType::Float64 => of(Physical::DOUBLE, None),
            CellType::Text => of(Physical::BYTE_ARRAY, Some(LogicalType::String)),
            CellType::Float32List => {
                let item = Type::primitive_type_builder(LIST_ITEM, Physical::FLOAT)
                    .with_repetition(Repetition::REQUIRED)
                    .build()?;
                let list = Type::group_type_builder(LIST)
                    .with_fields(vec![Arc::new(item)])
                    .with_repetition(Repetition::REPEATED)
                    .build()?;
                Type::group_type_builder(&self.name)
                    .with_fields(vec![Arc::new(list)])
                    .with_logical_type(Some(LogicalType::List))
                    .with_repetition(repetition(self.nullable))
                    .build()
            }
        };
        column.map(Arc::new)
    }

    /// Whether no cell is empty, and each is a number in double precision.
    fn holds_signals(&self) -> bool {
        self.cells == CellType::Float64 && !self.nullable
    }

    /// Names from the column to where its numbers are, as properties of the file name them.
    ///
    /// # Arguments
    /// * `name` - of a column of lists
    pub fn list_path(name: &str) -> Vec<String> {
        [name, LIST, LIST_ITEM].map(str::to_owned).to_vec()
    }
}

/// A table that is written, one group of rows after the other.
pub struct TableWriter<W: Write + Send> {
    file: SerializedFileWriter<HashedMetadata<W>>,
    columns: Vec<TableColumn>,
    /// Checksums of the headers of pages.
    headers: String,
    /// What the file says about itself besides.
    metadata: Vec<KeyValue>,
}

impl<W: Write + Send> TableWriter<W> {
    /// Begins a table.
    ///
    /// # Arguments
    /// * `to` - where the file is written to; it needs no buffer
    /// * `columns` - its columns
    /// * `properties` - compression and encodings, and what the file says about itself
    ///
    /// # Errors
    /// Those of `to`; two columns of one name, before anything is written: no reader opens such a file.
    pub fn new(to: W, columns: Vec<TableColumn>, properties: WriterProperties) -> io::Result<Self> {
        Self::try_new(to, columns, properties).map_err(into_io)
    }

    fn try_new(to: W, columns: Vec<TableColumn>, properties: WriterProperties) -> Result<Self> {
        let mut names = HashSet::new();
        if let Some(twice) = columns.iter().find(|column| !names.insert(&column.name)) {
            return Err(ParquetError::General(format!("two columns are called {}", twice.name)));
        }
        let fields = columns.iter().map(TableColumn::schema).collect::<Result<_>>()?;
        let schema = Arc::new(Type::group_type_builder(TABLE).with_fields(fields).build()?);
        let mut file = SerializedFileWriter::new(HashedMetadata::new(to), schema, Arc::new(properties))?;
        let arrow = arrow_schema::encode(&columns);
        file.append_key_value_metadata(KeyValue::new(arrow_schema::KEY.to_owned(), arrow));
        Ok(Self { file, columns, headers: String::new(), metadata: Vec::new() })
    }

    /// Writes rows as a group of their own.
    ///
    /// # Arguments
    /// * `cells` - of each column, as many in each
    ///
    /// # Errors
    /// Those of the file; cells that are none of their column.
    pub fn write_rows(&mut self, cells: Vec<Cells>) -> io::Result<()> {
        self.try_write(cells).map_err(into_io)
    }

    fn try_write(&mut self, cells: Vec<Cells>) -> Result<()> {
        let (given, needed) = (cells.len(), self.columns.len());
        if given != needed {
            return Err(ParquetError::General(format!("{given} columns instead of {needed}")));
        }
        let properties = Arc::clone(self.file.properties());
        let leaves = self.file.schema_descr().columns().to_vec();
        let mut group = self.file.next_row_group()?;
        for ((column, leaf), cells) in self.columns.iter().zip(leaves).zip(cells) {
            let mut bytes = Vec::new();
            let pages = ChecksummedPages { to: &mut bytes, headers: &mut self.headers };
            let closed = match cells {
                Cells::Signal(signal)
                    if !signal.is_empty()
                        && column.holds_signals()
                        && split_signal::applies_to(&properties, leaf.path()) =>
                {
                    split_signal::encode(leaf, signal, pages)?
                }
                cells => {
                    let mut writer = get_column_writer(leaf, Arc::clone(&properties), Box::new(pages));
                    write_cells(&mut writer, column, cells)?;
                    writer.close()?
                }
            };
            self.headers.push(page_checksum::BETWEEN_COLUMNS);
            group.append_column(&Bytes::from(bytes), closed)?;
        }
        group.close().map(drop)
    }

    /// Adds to what the file says about itself.
    ///
    /// # Arguments
    /// * `entries` - keys and values
    pub fn add_metadata(&mut self, entries: impl IntoIterator<Item = (impl Into<String>, String)>) {
        self.metadata.extend(entries.into_iter().map(|(key, value)| KeyValue::new(key.into(), value)));
    }

    /// Ends the table.
    ///
    /// # Errors
    /// Those of the file.
    pub fn close(self) -> io::Result<()> {
        let Self { mut file, headers, metadata, .. } = self;
        let headers = KeyValue::new(page_checksum::KEY.to_owned(), headers);
        // Last, so that hashes lie near the file's end.
        let hash = KeyValue::new(metadata_hash::KEY.to_owned(), UNKNOWN_HASH.to_owned());
        let entries = std::iter::once(headers).chain(metadata).chain([hash]);
        entries.for_each(|entry| file.append_key_value_metadata(entry));
        file.flush()?;
        file.inner_mut().begin_end();
        file.into_inner().map_err(into_io)?.finish()
    }
}

/// Writes a whole table in one group of rows, compressed by Zstandard.
///
/// # Arguments
/// * `to` - where the file is written to; it needs no buffer
/// * `columns` - its columns
/// * `rows`, `cells` - how many rows, and the cells of each column
/// * `metadata` - keys and values that the file says about itself
///
/// # Errors
/// As [`TableWriter::new`] and [`TableWriter::write_rows`].
pub(crate) fn write_compressed(
    to: impl Write + Send,
    columns: Vec<TableColumn>,
    rows: usize,
    cells: Vec<Cells>,
    metadata: impl IntoIterator<Item = (&'static str, String)>,
) -> io::Result<()> {
    let compression = ZstdLevel::try_new(1).map(Compression::ZSTD).map_err(io::Error::other)?;
    let properties = WriterProperties::builder().set_compression(compression).build();
    let mut table = TableWriter::new(to, columns, properties)?;
    table.add_metadata(metadata);
    if rows > 0 {
        table.write_rows(cells)?;
    }
    table.close()
}

fn write_cells(writer: &mut ColumnWriter, column: &TableColumn, cells: Cells) -> Result<()> {
    match (column.cells, cells) {
        (CellType::Int32, Cells::Int32(cells)) => write::<Int32Type>(writer, column, cells),
        (CellType::Int64, Cells::Int64(cells)) => write::<Int64Type>(writer, column, cells),
        (CellType::Float64, Cells::Float64(cells)) => write::<DoubleType>(writer, column, cells),
        (_, Cells::Signal(signal)) if column.holds_signals() => {
            get_typed_column_writer_mut::<DoubleType>(writer).write_batch(signal, None, None).map(drop)
        }
        (CellType::Text, Cells::Text(cells)) => {
            let texts = cells.into_iter().map(|cell| cell.map(|text| ByteArray::from(text.into_bytes())));
            write::<ByteArrayType>(writer, column, texts)
        }
        (CellType::Float32List, Cells::Float32List(lists)) if !column.nullable => write_lists(writer, &lists),
        _ => Err(ParquetError::General(format!("column {} holds {:?}", column.name, column.cells))),
    }
}

fn write<T: DataType>(
    writer: &mut ColumnWriter,
    column: &TableColumn,
    cells: impl IntoIterator<Item = Option<T::T>>,
) -> Result<()> {
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    for cell in cells {
        levels.push(i16::from(cell.is_some()));
        values.extend(cell);
    }
    if !column.nullable && values.len() < levels.len() {
        return Err(ParquetError::General(format!("column {} has an empty cell", column.name)));
    }
    let levels = column.nullable.then_some(&levels[..]);
    get_typed_column_writer_mut::<T>(writer).write_batch(&values, levels, None).map(|_| ())
}

/// Dremel's levels: an item that begins its list has no repetition, and an empty list no definition.
fn write_lists(writer: &mut ColumnWriter, lists: &[&[f32]]) -> Result<()> {
    let count = lists.iter().map(|list| list.len().max(1)).sum();
    let (mut definitions, mut repetitions) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for list in lists {
        definitions.resize(definitions.len() + list.len().max(1), i16::from(!list.is_empty()));
        repetitions.push(0);
        repetitions.resize(definitions.len(), 1);
    }
    let values = lists.concat();
    get_typed_column_writer_mut::<FloatType>(writer)
        .write_batch(&values, Some(&definitions), Some(&repetitions))
        .map(|_| ())
}
