//! Checks of a Parquet file's metadata, where the `parquet` crate would panic rather than refuse.

use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData};

/// Bytes of samples that a byte of a file may at most stand for, as pages may repeat a number any number of times.
const MAX_COMPRESSION: u64 = 4096;
/// Bytes of samples that any file may have.
const ALWAYS_BYTES: u64 = 1 << 30;

/// Finds what is impossible in the metadata.
///
/// # Arguments
/// * `metadata` - of the file
/// * `file_bytes` - its length
pub(super) fn check(metadata: &ParquetMetaData, file_bytes: u64) -> Result<(), String> {
    let mut rows: i64 = 0;
    for (index, group) in metadata.row_groups().iter().enumerate() {
        let there = group.num_rows();
        rows = rows.checked_add(there).filter(|_| there >= 0).ok_or("it has an impossible number of rows")?;
        for column in group.columns() {
            let name = column.column_path().string();
            if !is_inside(column, file_bytes) {
                return Err(format!("column {name} of row group {} is not inside the file", index + 1));
            }
        }
    }
    if rows != metadata.file_metadata().num_rows() {
        let stated = metadata.file_metadata().num_rows();
        return Err(format!("it states {stated} rows, but its row groups have {rows}"));
    }
    let columns = metadata.file_metadata().schema_descr().num_columns();
    let bytes = (rows as u64).saturating_mul(8 * columns as u64);
    if bytes > file_bytes.saturating_mul(MAX_COMPRESSION).max(ALWAYS_BYTES) {
        return Err(format!("it states {rows} rows, which is not possible in {file_bytes} bytes"));
    }
    Ok(())
}

fn is_inside(column: &ColumnChunkMetaData, file_bytes: u64) -> bool {
    let start = column.dictionary_page_offset().unwrap_or(column.data_page_offset());
    let range = u64::try_from(start).ok().zip(u64::try_from(column.compressed_size()).ok());
    let end = range.and_then(|(start, length)| start.checked_add(length));
    end.is_some_and(|end| end <= file_bytes) && column.data_page_offset() >= 0 && column.num_values() >= 0
}
