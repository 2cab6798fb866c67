//! Tables of which a bit is turned over are refused, or read as they were written.
#![allow(clippy::unwrap_used)]

use bytes::Bytes;
use meshtone_io::table::{CellType, Cells, TableColumn, TableReader, TableWriter};
use parquet::basic::{Compression, Encoding, ZstdLevel};
use parquet::errors::Result;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::ColumnPath;

/// Everything that a table's readers give of it.
#[derive(Debug, PartialEq, Default)]
struct Content {
    columns: Vec<String>,
    numbers: Vec<Vec<u64>>,
    texts: Vec<Vec<Option<String>>>,
    lists: Vec<Vec<f64>>,
}

/// A column of each kind, as those of data sets and signals are written, in two groups of rows.
fn table() -> Vec<u8> {
    let column = TableColumn::new;
    let columns = vec![
        column("time_s", CellType::Float64).with_metadata([("unit", "s")]),
        TableColumn { nullable: true, ..column("speed_hz", CellType::Float64) },
        column("record", CellType::Int64),
        column("severity", CellType::Int32),
        TableColumn { nullable: true, ..column("label", CellType::Text) },
        column("vertical_g", CellType::Float32List),
    ];
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(1).unwrap()))
        .set_statistics_enabled(EnabledStatistics::Chunk);
    for path in [vec!["time_s".to_owned()], TableColumn::list_path("vertical_g")].map(ColumnPath::new) {
        properties = properties
            .set_column_dictionary_enabled(path.clone(), false)
            .set_column_encoding(path.clone(), Encoding::BYTE_STREAM_SPLIT)
            .set_column_statistics_enabled(path, EnabledStatistics::None);
    }
    let properties =
        properties.set_column_compression(ColumnPath::from("time_s"), Compression::SNAPPY).build();
    let mut file = Vec::new();
    let mut table = TableWriter::new(&mut file, columns, properties).unwrap();
    for group in 0..2 {
        let rows = || (0..20).map(move |row| 20 * group + row);
        let signal: Vec<f64> = rows().map(|row| f64::from(row) / 7.0).collect();
        let lists: Vec<Vec<f32>> = rows().map(|row| vec![row as f32 / 3.0; 3 + row as usize % 4]).collect();
        let cells = vec![
            Cells::Signal(&signal),
            Cells::Float64(rows().map(|row| (row % 5 != 1).then_some(f64::from(row / 3))).collect()),
            Cells::Int64(rows().map(|row| Some(row.into())).collect()),
            Cells::Int32(rows().map(|row| Some(row % 3)).collect()),
            Cells::Text(
                rows()
                    .map(|row| (row % 7 != 2).then(|| ["pit", "wear"][row as usize % 2].to_owned()))
                    .collect(),
            ),
            Cells::Float32List(lists.iter().map(Vec::as_slice).collect()),
        ];
        table.write_rows(cells).unwrap();
    }
    table.add_metadata([("meshtone.records", "40".to_owned())]);
    table.close().unwrap();
    file
}

fn content(file: &[u8]) -> Result<Content> {
    let table = TableReader::new(Bytes::copy_from_slice(file))?;
    let mut content = Content {
        columns: table.columns().iter().map(|column| format!("{column:?}")).collect(),
        ..Content::default()
    };
    for column in table.columns() {
        match column.name.as_str() {
            "label" => content.texts.push(table.texts(column)?),
            "vertical_g" => {
                for group in 0..table.groups() {
                    content.lists.extend(table.lists(column, group)?);
                }
            }
            _ => content
                .numbers
                .push(table.numbers(column, 0)?.values.iter().map(|value| value.to_bits()).collect()),
        }
    }
    Ok(content)
}

/// All bits of the pages, and some of the metadata, which have one hash.
#[test]
fn no_flipped_bit_changes_what_is_read() {
    let file = table();
    let whole = content(&file).unwrap();
    let length = file[file.len() - 8..].first_chunk().map(|bytes| u32::from_le_bytes(*bytes)).unwrap();
    let pages = 8 * (file.len() - 8 - length as usize);
    let mut refused = 0;
    for bit in (0..pages).chain((pages..8 * file.len()).step_by(5)) {
        let mut changed = file.clone();
        changed[bit / 8] ^= 1 << (bit % 8);
        match content(&changed) {
            Ok(read) => assert_eq!(read, whole, "bit {bit}"),
            Err(_) => refused += 1,
        }
    }
    assert!(10 * refused > 9 * pages, "{refused} of {pages} and more");
}

/// The end of a list is known by the next page, whose header is looked at before its page is read.
#[test]
fn lists_in_several_pages_are_read() {
    let mut file = Vec::new();
    let columns = vec![TableColumn::new("vertical_g", CellType::Float32List)];
    let mut table = TableWriter::new(&mut file, columns, WriterProperties::builder().build()).unwrap();
    let lists: Vec<Vec<f32>> = (0..20).map(|row| (0..60_000).map(|at| (row * at) as f32).collect()).collect();
    table.write_rows(vec![Cells::Float32List(lists.iter().map(Vec::as_slice).collect())]).unwrap();
    table.close().unwrap();
    let table = TableReader::new(Bytes::from(file)).unwrap();
    let column = table.column("vertical_g").unwrap();
    assert!(table.metadata().row_group(0).column(0).compressed_size() > 2 << 20);
    let read = table.lists(column, 0).unwrap();
    assert!(read.iter().flatten().copied().eq(lists.iter().flatten().map(|&value| f64::from(value))));
}
