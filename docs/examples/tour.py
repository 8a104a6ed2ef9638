# A walk through the Python module, cell by cell, as notebooks and editors show files with such marks.
# Run it as it is:  python3 docs/examples/tour.py

# %% The built-in patient, with a stone in the gallbladder. open_case() opens a case, a CT file or a DICOM folder.
import numpy as np

import insonate

case = insonate.phantom(gallstone=True, voxel_mm=2)
print(case.name, case.ct.shape, "voxels;", ", ".join(case.views))

# %% A picture at one of its views: the probe is held as an expert holds it.
simulator = insonate.Simulator(case)
view = case.views["gallbladder_long"]
simulator.set_probe(view.probe, view.depth_mm)
simulator.pose = view.pose
simulator.set(image_width=512, image_height=512)
picture = simulator.image()
print(view.title, picture.shape, picture.dtype, "on", simulator.device)

# %% Which pixels show the stone, and whether the sound reaches behind it.
truth = simulator.truth()
value = {name: number for number, name in case.label_names.items()}
stone = truth["label"] == value["gallstone"]
print("the stone covers", stone.sum(), "pixels; the sound arrives at", (truth["reach"] == 2).mean().round(2), "of all")

# %% Where a pixel lies in the patient: here the middle of the stone, in mm.
rows, columns = np.nonzero(stone)
middle = simulator.patient_from_pixel @ [columns.mean(), rows.mean(), 0, 1]
print("the stone lies at", middle[:3].round(1))

# %% A batch: the probe is tilted in steps of 2 degrees about its lateral axis.
def tilted(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return view.pose @ [[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]]

poses = np.array([tilted(angle) for angle in range(-10, 11, 2)])
batch = simulator.images(poses, labels=True)
seen = (batch["visible_label"] == value["gallstone"]).sum(axis=(1, 2))
print("pixels of the stone by tilt:", dict(zip(range(-10, 11, 2), seen.tolist())))

# %% The gain is a setting; so is everything else that a picture depends on.
simulator.set(gain_db=10)
print("10 dB of gain brighten the picture from", picture.mean().round(1), "to", simulator.image().mean().round(1))

# %% ImageSimilarity: LC2 finds how far to the side a picture was taken.
def moved(millimetres):
    return view.pose @ [[1, 0, 0, millimetres], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]

with insonate.ImageSimilarity(case, picture, view.probe, view.depth_mm) as comparison:
    similarity = comparison.similarity(np.array([moved(x) for x in range(-20, 21, 4)]))
print("most similar", range(-20, 21, 4)[int(similarity.argmax())], "mm to the side")

# %% What cannot be used raises one sentence.
try:
    simulator.set(gian_db=3)
except insonate.InputError as error:
    print(error)

# %% The simulator holds graphics memory until it is closed; `with insonate.Simulator(case) as simulator:` does it itself.
simulator.close()
