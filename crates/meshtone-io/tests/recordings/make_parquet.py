"""Writes the Parquet files of the tests with pyarrow and polars: python make_parquet.py"""

import decimal
from datetime import date, time
from pathlib import Path

import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq

folder = Path(__file__).parent
rows = range(60)
signal = [row / 8 - 3 for row in rows]
other = [
    ("truth", pa.bool_(), [row % 2 == 0 for row in rows]),
    ("text", pa.string(), [str(row) for row in rows]),
    ("long text", pa.large_string(), [str(row) for row in rows]),
    ("bytes", pa.binary(), [b"x"] * 60),
    ("half", pa.float16(), [0.5] * 60),
    ("day", pa.date32(), [date(2024, 1, 1)] * 60),
    ("hour", pa.time64("us"), [time(12)] * 60),
    ("money", pa.decimal128(9, 2), [decimal.Decimal("1.25")] * 60),
    ("nothing", pa.null(), [None] * 60),
    ("list", pa.list_(pa.float64()), [[1.0, 2.0]] * 60),
    ("group", pa.struct([("a", pa.float64()), ("b", pa.list_(pa.int8()))]), [{"a": 1.0, "b": [1]}] * 60),
    ("map", pa.map_(pa.string(), pa.float64()), [[("a", 1.0)]] * 60),
]


def table(columns):
    fields = [pa.field(name, kind, metadata=metadata) for name, kind, _, metadata in columns]
    arrays = [pa.array(values, kind) for _, kind, values, _ in columns]
    return pa.table(arrays, schema=pa.schema(fields))


# Every type of numbers, between columns that hold none.
numbers = [
    (str(kind), kind, [row - 30 if kind.bit_width and "u" not in str(kind) else row for row in rows], None)
    for kind in [pa.int8(), pa.int16(), pa.int32(), pa.int64(), pa.uint8(), pa.uint16(), pa.uint32(), pa.uint64()]
]
numbers += [("large", pa.uint64(), [2**63 + 2048 * row for row in rows], None)]
numbers += [("large32", pa.uint32(), [2**31 + row for row in rows], None)]
numbers += [("float", pa.float32(), signal, {"unit": "m/s²"}), ("double", pa.float64(), signal, {"units": "g"})]
mixed = [part for pair in zip(numbers, [(*column, None) for column in other]) for part in pair]
pq.write_table(table(mixed), folder / "types.parquet", compression="snappy")

# Every encoding and compression, in groups of rows and pages of their own; without dictionaries where an encoding is named.
encodings = {"delta": "DELTA_BINARY_PACKED", "split": "BYTE_STREAM_SPLIT", "plain": "PLAIN", "single": "BYTE_STREAM_SPLIT"}
encoded = table(
    [
        ("delta", pa.int64(), [row * row for row in rows], None),
        ("split", pa.float64(), signal, None),
        ("plain", pa.float64(), signal, None),
        ("single", pa.float32(), signal, None),
    ]
)
for version, compression in [("1.0", "gzip"), ("2.0", "zstd"), ("2.0", "lz4"), ("1.0", "none")]:
    pq.write_table(
        encoded,
        folder / f"encodings_{compression}.parquet",
        data_page_version=version,
        compression=compression,
        use_dictionary=False,
        column_encoding=encodings,
        row_group_size=25,
        data_page_size=64,
        write_batch_size=8,
    )

# Moments and durations in every unit, 1 ms apart but for those in seconds.
start = 1_700_000_000
moments = [
    ("second", pa.timestamp("s"), [start + row for row in rows], None),
    ("milli", pa.timestamp("ms", "UTC"), [start * 10**3 + row for row in rows], None),
    ("micro", pa.timestamp("us"), [start * 10**6 + 1000 * row for row in rows], None),
    ("nano", pa.timestamp("ns"), [start * 10**9 + 10**6 * row for row in rows], None),
    ("duration s", pa.duration("s"), list(rows), None),
    ("duration ms", pa.duration("ms"), list(rows), None),
    ("duration us", pa.duration("us"), [1000 * row for row in rows], None),
    ("duration ns", pa.duration("ns"), [10**6 * row for row in rows], None),
    ("a", pa.float64(), signal, None),
]
pq.write_table(table(moments), folder / "moments.parquet")
pq.write_table(table(moments[:4] + moments[-1:]), folder / "moments_int96.parquet", use_deprecated_int96_timestamps=True)

# Gaps: what is no time and no channel may have them.
gaps = table([("a", pa.float64(), signal, None), ("b", pa.float64(), [None if row == 41 else 1.0 for row in rows], None)])
pq.write_table(gaps, folder / "gaps.parquet", row_group_size=20)

# A codec that is not read.
pq.write_table(table([("a", pa.float64(), signal, None)]), folder / "brotli.parquet", compression="brotli")

pl.DataFrame(
    {"time": [row / 100 for row in rows], "a": pl.Series(signal, dtype=pl.Float32), "note": ["x"] * 60, "b": list(rows)}
).write_parquet(folder / "polars.parquet")
