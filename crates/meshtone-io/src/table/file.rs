//! A Parquet file in the making, column by column.
//!
//! The `parquet` crate's writer of files takes values and encodes them itself; here its parts are put together, so that a column
//! can also bring pages that were encoded elsewhere.

use std::io::{self, Write};
use std::mem;
use std::sync::{Arc, OnceLock};

use parquet::column::writer::{ColumnCloseResult, ColumnWriter, get_column_writer};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::page_index::PageIndexBuilder;
use parquet::file::metadata::{
    FileMetaData, KeyValue, ParquetMetaDataBuilder, ParquetMetaDataWriter, RowGroupMetaData,
};
use parquet::file::page_index::column_index::ColumnIndexMetaData;
use parquet::file::page_index::offset_index::OffsetIndexMetaData;
use parquet::file::properties::{WriterProperties, WriterPropertiesPtr};
use parquet::file::writer::{SerializedPageWriter, TrackedWrite};
use parquet::schema::types::{SchemaDescPtr, SchemaDescriptor, TypePtr};

use super::split_signal::{Signal, SplitSignal};

/// What a Parquet file begins with.
const MAGIC: &[u8; 4] = b"PAR1";

/// Where a column's pages are, and what their extremes are.
type PageIndexes = (Option<ColumnIndexMetaData>, Option<OffsetIndexMetaData>);

/// A file that is written from its start to its end.
pub(super) struct TableFile<W: Write> {
    to: TrackedWrite<Watched<W>>,
    /// The first that failed of what was written.
    problem: Arc<OnceLock<io::Error>>,
    schema: SchemaDescPtr,
    properties: WriterPropertiesPtr,
    metadata: Vec<KeyValue>,
    groups: Vec<RowGroupMetaData>,
    /// Of each group and column.
    page_indexes: Vec<Vec<PageIndexes>>,
    /// The columns of the group that is written.
    columns: Vec<ColumnCloseResult>,
    split_signal: SplitSignal,
}

impl<W: Write + Send> TableFile<W> {
    pub(super) fn new(to: W, schema: TypePtr, properties: WriterProperties) -> Result<Self> {
        let problem = Arc::default();
        let mut to = TrackedWrite::new(Watched { to, problem: Arc::clone(&problem) });
        to.write_all(MAGIC)?;
        Ok(Self {
            to,
            problem,
            schema: Arc::new(SchemaDescriptor::new(schema)),
            metadata: properties.key_value_metadata().cloned().unwrap_or_default(),
            properties: Arc::new(properties),
            groups: Vec::new(),
            page_indexes: Vec::new(),
            columns: Vec::new(),
            split_signal: SplitSignal::new(),
        })
    }

    pub(super) fn add_metadata(&mut self, entry: KeyValue) {
        self.metadata.push(entry);
    }

    /// Writes the next column of a group.
    ///
    /// # Arguments
    /// * `values` - writes the column's values
    pub(super) fn write_column(
        &mut self,
        values: impl FnOnce(&mut ColumnWriter) -> Result<()>,
    ) -> Result<()> {
        let pages = Box::new(SerializedPageWriter::new(&mut self.to));
        let column = self.schema.column(self.columns.len());
        let mut writer = get_column_writer(column, Arc::clone(&self.properties), pages);
        values(&mut writer)?;
        let closed = writer.close()?;
        self.columns.push(closed);
        Ok(())
    }

    /// Writes the next column of a group, if it is to be split into its bytes and compressed by Snappy; returns whether it did.
    pub(super) fn try_write_split(&mut self, signal: &Signal) -> Result<bool> {
        let column = self.schema.column(self.columns.len());
        let is_meant = SplitSignal::is_meant(&self.properties, column.path()) && signal.rows() > 0;
        if is_meant {
            let statistics = self.properties.statistics_enabled(column.path());
            let mut pages = SerializedPageWriter::new(&mut self.to);
            self.columns.push(self.split_signal.write(&mut pages, column, signal, statistics)?);
        }
        Ok(is_meant)
    }

    /// Ends a group of rows.
    ///
    /// # Arguments
    /// * `start` - [`Self::bytes_written`] before its first column
    pub(super) fn end_group(&mut self, start: usize) -> Result<()> {
        let columns = mem::take(&mut self.columns);
        let rows = columns.first().map_or(0, |column| column.rows_written);
        if let Some(other) = columns.iter().find(|column| column.rows_written != rows) {
            let problem = format!("columns of {rows} and of {} rows", other.rows_written);
            return Err(ParquetError::General(problem));
        }
        let ordinal = i32::try_from(self.groups.len());
        let ordinal = ordinal.map_err(|_| ParquetError::General("too many groups of rows".to_owned()))?;
        let bytes = columns.iter().map(|column| column.metadata.uncompressed_size()).sum();
        let (metadata, indexes) = columns
            .into_iter()
            .map(|column| (column.metadata, (column.column_index, column.offset_index)))
            .unzip();
        let group = RowGroupMetaData::builder(Arc::clone(&self.schema))
            .set_column_metadata(metadata)
            .set_total_byte_size(bytes)
            .set_num_rows(rows as i64)
            .set_ordinal(ordinal)
            .set_file_offset(start as i64)
            .build()?;
        self.groups.push(group);
        self.page_indexes.push(indexes);
        Ok(())
    }

    pub(super) fn bytes_written(&self) -> usize {
        self.to.bytes_written()
    }

    /// Ends the file.
    pub(super) fn close(self) -> Result<()> {
        let mut index = PageIndexBuilder::new(self.groups.len(), self.schema.num_columns());
        for (group, columns) in self.page_indexes.into_iter().enumerate() {
            for (column, (extremes, places)) in columns.into_iter().enumerate() {
                extremes.into_iter().for_each(|extremes| index.put_column_index(extremes, group, column));
                places.into_iter().for_each(|places| index.put_offset_index(places, group, column));
            }
        }
        let file = FileMetaData::new(
            self.properties.writer_version().as_num(),
            self.groups.iter().map(RowGroupMetaData::num_rows).sum(),
            Some(self.properties.created_by().to_owned()),
            Some(self.metadata),
            self.schema,
            // Those of the columns' types are written.
            None,
        );
        let metadata = ParquetMetaDataBuilder::new(file)
            .set_row_groups(self.groups)
            .set_page_index(Some(Arc::new(index.build())))
            .build();
        ParquetMetaDataWriter::new_with_tracked(self.to, &metadata).finish()?;
        // What the buffer still held has been written when it was dropped, which tells nobody of errors.
        let problem = Arc::into_inner(self.problem).and_then(OnceLock::into_inner);
        problem.map_or(Ok(()), |problem| Err(problem.into()))
    }
}

/// Remembers the first error of a writer.
struct Watched<W> {
    to: W,
    problem: Arc<OnceLock<io::Error>>,
}

impl<W: Write> Watched<W> {
    fn watch<T>(&mut self, act: impl FnOnce(&mut W) -> io::Result<T>) -> io::Result<T> {
        act(&mut self.to).inspect_err(|error| {
            if error.kind() != io::ErrorKind::Interrupted {
                self.problem.get_or_init(|| copy_of(error));
            }
        })
    }
}

impl<W: Write> Write for Watched<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.watch(|to| to.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.watch(W::flush)
    }
}

fn copy_of(error: &io::Error) -> io::Error {
    match error.raw_os_error() {
        Some(code) => io::Error::from_raw_os_error(code),
        None => io::Error::new(error.kind(), error.to_string()),
    }
}
