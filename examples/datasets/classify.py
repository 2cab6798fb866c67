"""Is there something to learn in a data set, and how much is lost where the machine changes?

Trains a tree ensemble and a linear classifier on the indicators of the training units, beside what is known of a machine anyway (teeth, speed,
load), and prints accuracy and confusion matrix on the test units, and the accuracy on every shifted split.

    pip install polars scikit-learn
    python classify.py benchmark
"""

import sys

import numpy as np
import polars as pl
from sklearn.ensemble import ExtraTreesClassifier
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import confusion_matrix
from sklearn.model_selection import train_test_split
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

PARTS = ("average", "regular", "residual", "difference", "envelope")
# What is known of a machine without looking at its vibration.
CONDITIONS = ("pinion_speed_hz", "brake_torque_nm", "pinion_teeth", "gear_teeth", "module_mm", "face_width_mm")
GEAR = ("fm0", "fm4", "m6a", "m8a", "na4", "energy_ratio", "sideband_level_factor")

records = pl.scan_parquet(f"{sys.argv[1]}/data/*.parquet")
names = records.collect_schema().names()
indicators = [name for name in names if name.startswith(tuple(f"{part}_" for part in PARTS)) and name not in ("average_g", "difference_g")]
indicators += [name for name in names if name in GEAR]
conditions = [name for name in CONDITIONS if name in names]
frame = records.select("label", "split", "severity", *dict.fromkeys(indicators + conditions)).drop_nulls().collect()


def inputs(part):
    # Indicators span decades; a skewness may be negative.
    values = np.arcsinh(part.select(indicators).to_numpy() * 100)
    return np.hstack([values, np.log(part.select(conditions).to_numpy())])


def of(split):
    part = frame.filter(pl.col("split") == split)
    return inputs(part), part["label"].to_numpy()


train_x, train_y = of("train")
classes = sorted(set(train_y))
splits = [split for split in frame["split"].unique(maintain_order=True).sort() if split != "train"]
models = {
    "trees": ExtraTreesClassifier(300, min_samples_leaf=2, random_state=1, n_jobs=-1),
    "linear": make_pipeline(StandardScaler(), LogisticRegression(max_iter=5000, C=10.0)),
}
print(f"{len(train_y)} records to train with, {len(indicators)} indicators, chance {1 / len(classes):.3f}")
for name, model in models.items():
    model.fit(train_x, train_y)
    print(f"\n{name}:")
    for split in splits:
        x, y = of(split)
        found = model.predict(x)
        accuracy = np.mean(found == y)
        balanced = np.mean([np.mean(found[y == label] == label) for label in classes if np.any(y == label)])
        print(f"  {split:12} {len(y):6} records  accuracy {accuracy:.3f}  mean over classes {balanced:.3f}")
    x, y = of("test")
    grades = frame.filter(pl.col("split") == "test")["severity"].to_numpy()
    by_grade = [f"{grade}: {np.mean((model.predict(x) == y)[grades == grade]):.2f}" for grade in np.unique(grades)]
    print("  test, accuracy by severity:", ", ".join(by_grade))
    print("\n  test, rows: true class, columns: predicted, in the order", ", ".join(classes))
    for label, row in zip(classes, confusion_matrix(y, model.predict(x), labels=classes, normalize="true")):
        print(f"  {label:18}" + "".join(f"{value:7.2f}" for value in row))

# What a division at random instead of by unit would have promised.
unit_split = frame.filter(pl.col("split").is_in(["train", "test"]))
x, y = inputs(unit_split), unit_split["label"].to_numpy()
share = np.mean(unit_split["split"].to_numpy() == "test")
a, b, c, d = train_test_split(x, y, test_size=share, random_state=1, stratify=y)
leaky = ExtraTreesClassifier(300, min_samples_leaf=2, random_state=1, n_jobs=-1).fit(a, c)
print(f"\ntrees, the same records divided at random instead of by unit: accuracy {np.mean(leaky.predict(b) == d):.3f}")
