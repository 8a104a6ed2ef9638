from os import PathLike
from types import TracebackType
from typing import Any, Literal, TypedDict, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

class InputError(ValueError):
    """An input that cannot be used: one sentence that names it and says what to do."""

def probe_names() -> list[str]:
    """The names of the built-in probes."""

class Probe:
    """A transducer: a built-in one, or one that differs from it."""
    def __init__(self, like: str, *, radius_mm: float = ..., field_of_view_deg: float = ..., width_mm: float = ...,
                 aperture_mm: float = ..., frequency_mhz: float = ..., depth_mm: float = ..., lines: int = ...) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> Literal["linear", "curvilinear", "phased"]: ...
    @property
    def radius_mm(self) -> float: ...
    @property
    def field_of_view_deg(self) -> float: ...
    @property
    def width_mm(self) -> float: ...
    @property
    def aperture_mm(self) -> float:
        """The widest aperture of a line."""
    @property
    def frequency_mhz(self) -> float: ...
    @property
    def depth_mm(self) -> float:
        """The usual imaging depth."""
    @property
    def lines(self) -> int: ...

class View:
    """The pose in which an expert holds the probe to show a structure."""
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def probe(self) -> str: ...
    @property
    def depth_mm(self) -> float: ...
    @property
    def landmarks(self) -> list[str]: ...
    @property
    def targets(self) -> list[str]: ...
    @property
    def pose(self) -> NDArray[np.float64]:
        """patient_from_probe, 4 x 4."""

class Case:
    """A patient. Its arrays share the case's memory and cannot be written."""
    @property
    def name(self) -> str: ...
    @property
    def views(self) -> dict[str, View]: ...
    @property
    def label_names(self) -> dict[int, str]: ...
    @property
    def landmarks(self) -> dict[str, tuple[float, float, float]]:
        """Patient positions in mm, LPS."""
    @property
    def ct(self) -> NDArray[np.int16]:
        """Hounsfield units, indexed [k, j, i]."""
    @property
    def labels(self) -> NDArray[np.uint8] | None:
        """Label values on the CT's grid, indexed [k, j, i]; None if the case has none."""
    @property
    def patient_from_voxel(self) -> NDArray[np.float64]:
        """From (i, j, k, 1) to patient mm, 4 x 4."""

def open_case(path: Union[str, PathLike[str]]) -> Case:
    """Opens a case folder, a CT file or a DICOM folder. A scan with voxels of more than 1 mm is resampled to that. One
    without views gets "front" and "right_flank", if it shows a body. Raises InputError."""

def phantom(**options: Union[bool, float, str]) -> Case:
    """Makes the built-in patient, or takes it from the cache. Options are those of its recipe, such as gallstone=True.
    Raises InputError."""

class Truth(TypedDict):
    label: NDArray[np.uint8]
    visible_label: NDArray[np.uint8]
    reach: NDArray[np.uint8]
    skin_mm: NDArray[np.float32]

class LabelledImages(TypedDict):
    image: NDArray[np.uint8]
    label: NDArray[np.uint8]
    visible_label: NDArray[np.uint8]
    reach: NDArray[np.uint8]
    skin_mm: NDArray[np.float32]

class Stages(TypedDict, total=False):
    """What the settings leave out is not in it: with waves, as in the trainer, there are scattered, echo and wave, and
    without them reflection, reflection_beam, transmission and speckle."""
    intensity: NDArray[np.float32]
    reflection: NDArray[np.float32]
    reflection_beam: NDArray[np.float32]
    transmission: NDArray[np.float32]
    repeated: NDArray[np.float32]
    speckle: NDArray[np.float32]
    scattered: NDArray[np.float32]
    echo_re: NDArray[np.float32]
    echo_im: NDArray[np.float32]
    wave_re: NDArray[np.float32]
    wave_im: NDArray[np.float32]
    fused: NDArray[np.float32]
    inside: NDArray[np.uint8]
    image: NDArray[np.uint8]

class Simulator:
    """Draws pictures of a case. It begins at the case's first view, with the trainer's settings. Any thread may use it;
    a process that is forked may not."""
    def __init__(self, case: Case) -> None: ...
    def __enter__(self) -> Simulator: ...
    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None: ...
    def close(self) -> None:
        """Frees the graphics memory. Drawing then raises RuntimeError."""
    def set_probe(self, probe: Union[str, Probe], depth_mm: float | None = None) -> None:
        """Sets the probe, the depth (0.1 to 1000 mm) and the trainer's settings for them; only the size of pictures
        stays. Raises InputError."""
    @property
    def probe(self) -> Probe: ...
    @property
    def depth_mm(self) -> float: ...
    @property
    def settings(self) -> dict[str, Any]:
        """All settings by name. Change them with set()."""
    def set(self, **settings: Any) -> None:
        """Sets settings by name: set(gain_db=3, image_width=512). If one cannot be used, all stay. Pictures are of a probe
        at rest, so persistence changes nothing. Raises InputError."""
    @property
    def pose(self) -> NDArray[np.float64]:
        """patient_from_probe, 4 x 4, in mm (LPS). Any rigid matrix can be set. Raises InputError for another one."""
    @pose.setter
    def pose(self, patient_from_probe: ArrayLike) -> None: ...
    def image(self) -> NDArray[np.uint8]:
        """The picture, rows x columns."""
    @overload
    def images(self, poses: ArrayLike, *, labels: Literal[False] = False) -> NDArray[np.uint8]: ...
    @overload
    def images(self, poses: ArrayLike, *, labels: Literal[True]) -> LabelledImages:
        """The pictures at N poses (N x 4 x 4), N x rows x columns; with labels=True a dict of them and their truth."""
    def truth(self) -> Truth:
        """What is known of the picture: per pixel the label, the label where the sound arrives, and the reach (0 outside
        the fan, 1 in shadow, 2 where the sound arrives); per scan line the distance to the skin in mm, negative where
        the face is pressed in. Pixels have the marker on the left; line 0 is at the right of the picture."""
    def stages(self) -> Stages:
        """The stages of the picture, as sim/model/stages.h has them: fused, inside and image are pixels, the others are
        on scan lines, [sample, line]. Line 0 is at the right of the picture."""
    @property
    def patient_from_pixel(self) -> NDArray[np.float64]:
        """From (column, row, 0, 1) of the picture to patient mm, 4 x 4."""
    @property
    def device(self) -> str: ...

class ImageSimilarity:
    """Compares an ultrasound image with images that model W simulates of a case (LC2)."""
    def __init__(self, case: Case, ultrasound: ArrayLike, probe: Union[str, Probe], depth_mm: float | None = None,
                 settings: Union[str, PathLike[str], None] = None, patch: int | None = None) -> None:
        """The ultrasound image shows the probe's fan down to the depth as Simulator does; NaN excludes a pixel. The
        settings are a TOML file of model W. LC2 is the mean over patches of so many pixels, 4 to 128; 0: of the whole
        image at once. By default it is that of the settings, or without them a sixteenth of the image's width, as
        insonate-register has it. Raises InputError."""
    def __enter__(self) -> ImageSimilarity: ...
    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None: ...
    def close(self) -> None:
        """Frees the graphics memory. Comparing then raises RuntimeError."""
    def similarity(self, poses: ArrayLike) -> NDArray[np.float32]:
        """LC2 at each of N poses, 0 to 1."""
