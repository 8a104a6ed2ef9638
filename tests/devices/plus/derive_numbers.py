#!/usr/bin/env python3
"""Reads PLUS's recordings independently of Insonate and prints what plus_recordings_test.cpp expects of them.

    derive_numbers.py FOLDER > plus_recordings.json

Standard library only. Poses are printed as the recording's own matrices, chained but not made orthonormal.
"""
import json
import pathlib
import re
import sys
import zlib

# The path from the probe's frame to the one that counts as the patient's: transforms, and whether taken backwards.
TO_REFERENCE = [("ProbeToTracker", False), ("ReferenceToTracker", True)]
PATHS = {
    "BkCurvilinearScanConvertedData.igs.mha": [("StylusToTracker", False)],
    "NwirePhantomFreehandCropped.igs.mha": TO_REFERENCE,
    "Prostate10_tracker.igs.mha": [("ToolToTracker", False)],
    "SegmentationTest_BKMedical_RandomStepperMotionData2_Trimmed_Cropped_FlipX.igs.mha": [("ToolToTracker", False)],
    "SlidingProbeTrackingData.igs.mha": TO_REFERENCE,
    "TransformInterpolationTest.igs.mha": [("ProbeToTracker", False)],
    "UsSimulatorOutputSpinePhantom2CurvilinearBaselineNoUSCompressed.igs.mha": TO_REFERENCE,
    "WaterTankBottomTranslationTrackerBuffer-trimmed.igs.mha": TO_REFERENCE,
    "NrrdSample.igs.nrrd": [],
}


def multiplied(a, b):
    return [[sum(a[r][k] * b[k][c] for k in range(4)) for c in range(4)] for r in range(4)]


def inverted(m):
    """By Gauss and Jordan."""
    rows = [list(m[r]) + [float(r == c) for c in range(4)] for r in range(4)]
    for c in range(4):
        pivot = max(range(c, 4), key=lambda r: abs(rows[r][c]))
        rows[c], rows[pivot] = rows[pivot], rows[c]
        rows[c] = [x / rows[c][c] for x in rows[c]]
        for r in range(4):
            if r != c:
                rows[r] = [x - rows[r][c] * y for x, y in zip(rows[r], rows[c])]
    return [row[4:] for row in rows]


def read(path):
    data = path.read_bytes()
    nrrd = data.startswith(b"NRRD")
    end = data.index(b"\n\n") + 2 if nrrd else data.index(b"\n", data.index(b"ElementDataFile")) + 1
    frames, fields = {}, {}
    for line in data[:end].decode("latin-1").splitlines():
        parts = re.split(r":=|: " if nrrd else r"=", line, maxsplit=1)
        if len(parts) != 2:
            continue
        name, value = parts[0].strip(), parts[1].strip()
        frame = re.match(r"Seq_Frame(\d+)_(.*)", name)
        if frame:
            frames.setdefault(int(frame[1]), {})[frame[2]] = value
        else:
            fields[name] = value
    return frames, fields, data[end:], nrrd


def pose(frame, path):
    whole = [[float(r == c) for c in range(4)] for r in range(4)]
    for name, backwards in path:
        if frame.get(name + "TransformStatus", "").strip() != "OK":
            return None
        numbers = [float(x) for x in frame[name + "Transform"].split()]
        matrix = [numbers[4 * r:4 * r + 4] for r in range(4)]
        whole = multiplied(inverted(matrix) if backwards else matrix, whole)
    return whole


def images(fields, data, nrrd):
    """Per frame the sum of all values, and the value of the pixel at a third of the width and of the height."""
    sizes = [int(x) for x in fields["sizes" if nrrd else "DimSize"].split()]
    if len(sizes) == 2:
        sizes.append(1)
    width, height, count = sizes
    if width * height <= 1:
        return []
    if nrrd or fields.get("CompressedData") == "True":
        data = zlib.decompressobj(15 + 32).decompress(data)
    bytes_each = 2 if nrrd else 1
    found = []
    for f in range(count):
        first = f * width * height * bytes_each
        values = data[first:first + width * height * bytes_each]
        if bytes_each == 1:
            at = (height // 3) * width + width // 3
            found.append({"sum": sum(values), "pixel": values[at]})
    return [width, height, found]


def main(folder):
    result = {}
    for name, path in PATHS.items():
        frames, fields, data, nrrd = read(pathlib.Path(folder) / name)
        poses = [pose(frames[f], path) if path else None for f in sorted(frames)]
        chosen = sorted({0, 1, len(poses) // 2, len(poses) - 1} & set(range(len(poses))))
        result[name] = {
            "frames": len(frames),
            "usable": sum(p is not None for p in poses),
            "times": [float(frames[f]["Timestamp"]) for f in chosen if "Timestamp" in frames[f]],
            "poses": {str(f): poses[f] for f in chosen if poses[f]},
            "images": images(fields, data, nrrd) if "sizes" in fields or "DimSize" in fields else [],
        }
    lines = [f"  {json.dumps(name)}: {json.dumps(numbers)}" for name, numbers in result.items()]
    print("{\n" + ",\n".join(lines) + "\n}")


main(sys.argv[1])
