"""Ultrasound images of a CT, live and in batches, with their truth.

    import insonate

    case = insonate.phantom(gallstone=True)
    with insonate.Simulator(case) as simulator:
        view = case.views["gallbladder_long"]
        simulator.set_probe(view.probe, view.depth_mm)
        simulator.pose = view.pose
        picture = simulator.image()          # rows x columns, uint8
        labels = simulator.truth()["label"]  # of the same size

Poses are matrices patient_from_probe, 4 x 4, in mm and the patient's frame (LPS). Pictures are as clinics show them: the
probe's marker on the left. What cannot be used raises InputError, a ValueError with one sentence.
"""
from ._insonate import (
    Case, InputError, Probe, ImageSimilarity, Simulator, View, __version__, open_case, phantom, probe_names)

__all__ = ["Case", "InputError", "Probe", "ImageSimilarity", "Simulator", "View", "open_case", "phantom", "probe_names"]
