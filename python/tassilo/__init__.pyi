# Written by tools/python_stubs.py from the module; do not edit.
import os
from typing import Any, Dict, List, Literal, Optional, Tuple, Union, overload

import numpy
from numpy.typing import ArrayLike, NDArray

__version__: str

class Error(RuntimeError):
    """The outside world failed us: a file, a video, a configuration entry. Wrong arguments are ValueError or TypeError."""

class Region:
    """A set of pixels as sorted runs; need not be connected, may be empty.

    Immutable, hashable, picklable; equal sets are equal. It is a set of pixels: len() counts them, an empty region is false,
    `(column, row) in region` asks for one, and | & - ^ <= are those of sets."""
    @overload
    def __init__(self) -> None:
        """The empty region."""
    @overload
    def __init__(self, runs: ArrayLike) -> None:
        """From an (N, 3) array of whole numbers (row, begin, end), in any order; end is exclusive, empty runs are dropped, overlapping and touching ones joined."""
    @staticmethod
    def from_mask(mask: NDArray[Any]) -> Region:
        """The pixels of a (height, width) array that are true or not 0."""
    @staticmethod
    def from_box(box: Tuple[int, int, int, int]) -> Region:
        """All pixels of a box (x0, y0, x1, y1), ends exclusive."""
    @property
    def runs(self) -> NDArray[numpy.int16]:
        """(N, 3) read-only array of (row, begin, end), without a copy; keeps the region alive."""
    @property
    def area(self) -> int:
        """Number of pixels."""
    @property
    def box(self) -> Tuple[int, int, int, int]:
        """Smallest box (x0, y0, x1, y1), ends exclusive; all 0 when empty."""
    def __len__(self) -> int:
        """Number of pixels."""
    def __bool__(self) -> bool:
        """Whether it has pixels."""
    def __contains__(self, pixel: Tuple[int, int]) -> bool:
        """Whether pixel (column, row) is in it."""
    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...
    def __or__(self, other: Region) -> Region: ...
    def __and__(self, other: Region) -> Region: ...
    def __sub__(self, other: Region) -> Region: ...
    def __xor__(self, other: Region) -> Region: ...
    def __le__(self, other: Region) -> bool: ...

@overload
def union_of(a: Region, b: Region) -> Region:
    """Pixels in a or in b."""
@overload
def union_of(regions: List[Region]) -> Region:
    """Pixels in any of the regions."""

def intersection(a: Region, b: Region) -> Region:
    """Pixels in a and in b."""

def difference(a: Region, b: Region) -> Region:
    """Pixels in a, not in b."""

def symmetric_difference(a: Region, b: Region) -> Region:
    """Pixels in exactly one of a and b."""

def complement(region: Region, domain: Tuple[int, int, int, int]) -> Region:
    """Pixels of the box `domain` that are not in the region."""

def translated(region: Region, columns: int = 0, rows: int = 0) -> Region:
    """The region moved to the right and down."""

def clipped(region: Region, box: Tuple[int, int, int, int]) -> Region:
    """Pixels of the region inside the box."""

def transposed(region: Region) -> Region:
    """Pixel (column, row) goes to (row, column)."""

def reflected(region: Region) -> Region:
    """Pixel (column, row) goes to (-column, -row)."""

def common_area(a: Region, b: Region) -> int:
    """Number of pixels in both."""

def overlaps(a: Region, b: Region) -> bool:
    """Whether a pixel is in both."""

def is_subset(inner: Region, outer: Region) -> bool:
    """Whether every pixel of `inner` is in `outer`."""

def hamming_distance(a: Region, b: Region) -> int:
    """Number of pixels in exactly one."""

def intersection_over_union(a: Region, b: Region) -> float:
    """Pixels in both over pixels in any, 0 to 1."""

def mirrored_left_right(region: Region, about: float) -> Region:
    """Pixel (column, row) goes to (2 about - column, row); about is a multiple of .5."""

def mirrored_top_bottom(region: Region, about: float) -> Region:
    """Pixel (column, row) goes to (column, 2 about - row); about is a multiple of .5."""

def zoomed(region: Region, columns: float, rows: float) -> Region:
    """The region drawn larger or smaller by factors > 0."""

def partition_into_rectangles(region: Region, width: int, height: int) -> List[Region]:
    """The region cut along a grid of cells of about this size."""

def mapped(region: Region, matrix: ArrayLike) -> Region:
    """The region moved by an affine map, a (2, 3) array: column and row of a pixel, then 1."""

def rotation_about(column: float, row: float, angle: float) -> NDArray[numpy.float64]:
    """The map that turns about a point, counter-clockwise on the screen [rad]; see mapped."""

def circle_region(column: float, row: float, radius: float) -> Region:
    """Pixels whose centres lie in a circle or on it."""

def ellipse_region(column: float, row: float, ra: float, rb: float, phi: float = 0.0) -> Region:
    """Pixels whose centres lie in an ellipse or on it."""

def rectangle_region(column: float, row: float, half_length: float, half_width: float, phi: float = 0.0) -> Region:
    """Pixels whose centres lie in a rectangle at any angle or on it."""

def rectangle(width: int, height: int) -> Region:
    """Centred element of width x height pixels."""

def disc(radius: float) -> Region:
    """Element of the pixels whose centres lie within the radius of the origin; 3.5 or so."""

def dilation(region: Region, element: Region) -> Region:
    """{p + e: p in region, e in element}."""

def erosion(region: Region, element: Region) -> Region:
    """{p: p + e in region for all e in element}."""

def opening(region: Region, element: Region) -> Region:
    """All places the element can reach inside the region."""

def closing(region: Region, element: Region) -> Region:
    """What the element cannot enter from outside."""

def diamond(radius: int) -> Region:
    """Element of the pixels at most `radius` steps along rows and columns away."""

def octagon(radius: int) -> Region:
    """Element of the pixels in a regular octagon, cheaper than a disc."""

def line_element(length_px: float, angle: float = 0.0) -> Region:
    """Element one pixel wide through the origin; angle counter-clockwise from right [rad]."""

def top_hat(region: Region, element: Region) -> Region:
    """What an opening takes away."""

def bottom_hat(region: Region, element: Region) -> Region:
    """What a closing adds."""

def hit_or_miss(region: Region, hit: Region, miss: Region) -> Region:
    """Places where `hit` lies in the region and `miss` outside."""

def inner_boundary(region: Region, neighbors: Literal[4, 8] = 4) -> Region:
    """Pixels of the region that have a neighbor outside."""

def outer_boundary(region: Region, neighbors: Literal[4, 8] = 4) -> Region:
    """Pixels outside the region that have a neighbor in it."""

def remove_noise(region: Region, neighbors: str = 'n_48') -> Region:
    """Pixels that have a neighbor in the region, of 'n_4' by edges, 'n_8' by corners, 'n_48' by either."""

def skeleton(region: Region) -> Region:
    """The middle lines of a region, one pixel wide."""

def components(region: Region, connectivity: Literal[4, 8] = 8) -> List[Region]:
    """The connected parts, in the order of their first runs."""

def component_features(region: Region, connectivity: Literal[4, 8] = 8) -> List[Dict[str, Any]]:
    """Area, center and box of every component, without making the components."""

def label_runs(region: Region, connectivity: Literal[4, 8] = 8) -> Tuple[NDArray[numpy.int32], int]:
    """The component of each run, 0 .. count - 1, and the count."""

def holes(region: Region, foreground: Literal[4, 8] = 8) -> Region:
    """Background that the region cuts off from outside."""

def fill_holes(region: Region, max_area_px: Optional[int] = None, foreground: Literal[4, 8] = 8, min_area_px: int = 1) -> Region:
    """The region with its holes filled; smaller ones than min_area_px and larger ones than max_area_px stay open."""

def regions_of_labels(labels: NDArray[Any], count: int) -> List[Region]:
    """One region a label 0 .. count - 1 of a (height, width) array."""

def to_mask(region: Region, window: Tuple[int, int, int, int], inside: int = 255) -> NDArray[numpy.uint8]:
    """(height, width) of uint8 for the pixels of a window (x0, y0, x1, y1): `inside` where the region is, else 0."""

def to_labels(regions: List[Region], window: Tuple[int, int, int, int]) -> NDArray[numpy.uint8]:
    """(height, width) of uint8 for the pixels of a window: k where regions[k] is, the last one wins, else 0."""

def region_from_polygon(vertices: ArrayLike, window: Tuple[int, int, int, int]) -> Region:
    """Pixels of the window whose centres are inside a closed polygon of (column, row) corners, by the even-odd rule."""

def outlines(region: Region, foreground: Literal[4, 8] = 8) -> List[Tuple[NDArray[numpy.float64], bool]]:
    """Closed polygons along the pixels' edges, one around each component and each hole: (corners, is_hole), corners (N, 2) of column, row."""

def center_outlines(region: Region) -> List[Tuple[NDArray[numpy.float64], bool]]:
    """Closed polygons through the centres of the border pixels, as `outlines`."""

def region_from_outlines(outlines: List[Tuple[ArrayLike, bool]], window: Tuple[int, int, int, int]) -> Region:
    """Pixels of the window whose centres are inside an odd number of the polygons; undoes `outlines`."""

def all_features() -> List[Any]:
    """All features that are one number: name, unit, meaning."""

def features(region: Region, names: Optional[List[str]] = None) -> Dict[str, Any]:
    """Features of a region by their names, all where none are given; 0 for the empty region."""

def feature_array(regions: List[Region], names: Optional[List[str]] = None) -> NDArray[Any]:
    """`features` of many regions: a structured array with a row for each region and the names as fields."""

def select(regions: List[Region], ranges: Dict[str, Any]) -> List[Region]:
    """The regions whose features lie in closed ranges: select(parts, {'area': (50, 1e9), 'circularity': (.8, 1)}); put the cheap features first."""

def sorted_by(regions: List[Region], feature: str, order: str = 'rising') -> List[Region]:
    """The regions ordered by a feature, 'rising' or 'falling'; equal ones keep their order. C++ calls it `sorted`."""

def sorted_by_first_point(regions: List[Region], order: str = 'rising') -> List[Region]:
    """The regions ordered by their first pixels, top to bottom, then left to right."""

def fill_up(region: Region, ranges: Dict[str, Any], foreground: Literal[4, 8] = 8) -> Region:
    """The region with those of its holes filled whose features lie in closed ranges."""

def area(region: Region) -> int:
    """Number of pixels."""

def bounding_box(region: Region) -> Tuple[int, int, int, int]:
    """Smallest box (x0, y0, x1, y1); all 0 when empty."""

def orientation(region: Region) -> float:
    """Direction of the ellipse's long axis towards the pixel farthest from the centre, (-pi, pi]."""

def contour_length(region: Region) -> float:
    """Length of the outer contours [px]."""

def compactness(region: Region) -> float:
    """max(1, contour_length^2 / (4 pi area))."""

def euler_number(region: Region, foreground: Literal[4, 8] = 8) -> int:
    """Components less holes."""

def hole_count(region: Region, foreground: Literal[4, 8] = 8) -> int:
    """Number of holes."""

def roundness(region: Region) -> Dict[str, Any]:
    """How round a region is: distance of the boundary from the centre, deviation, roundness, sides."""

def convex_hull(region: Region) -> NDArray[numpy.float64]:
    """(N, 2) corners (column, row) of the hull of the pixel centres, clockwise on the screen."""

def convex_area(region: Region) -> int:
    """Pixels in or on the convex hull."""

def convexity(region: Region) -> float:
    """area / convex_area."""

def rectangularity(region: Region) -> float:
    """How well the rectangle with the region's moments covers it; 1 for rectangles."""

def smallest_rectangle(region: Region) -> Dict[str, Any]:
    """The rectangle of least area around all pixel centres: column, row, half_length, half_width, phi."""

def smallest_circle(region: Region) -> Dict[str, Any]:
    """The smallest circle around all pixel centres: column, row, radius."""

def convex_region(region: Region) -> Region:
    """Pixels in or on the convex hull."""

def inner_circle(region: Region) -> Dict[str, Any]:
    """The largest circle inside: column, row, radius."""

def inner_rectangle(region: Region) -> Tuple[int, int, int, int]:
    """The box (x0, y0, x1, y1) of most pixels that lies in the region."""

def diameter(region: Region) -> Dict[str, Any]:
    """Two pixels as far apart as any: first and second (column, row), length."""

def feret_diameters(region: Region) -> Dict[str, Any]:
    """Largest and smallest extent over all directions: max, max_angle, min, min_angle."""

def feret_diameter(region: Region, angle: float) -> float:
    """Extent along a direction, counter-clockwise from right [rad]."""

def distance_to(region: Region, window: Tuple[int, int, int, int], metric: str = 'euclidean_squared') -> NDArray[numpy.int32]:
    """(height, width) of int32: for each pixel of the window the distance to the nearest pixel of the region, 2^31 - 1 for the empty region; metric 'euclidean_squared', 'chessboard' or 'city_block'."""

def distance_inside(region: Region, window: Tuple[int, int, int, int], metric: str = 'euclidean_squared') -> NDArray[numpy.int32]:
    """(height, width) of int32: for each pixel of the window the distance to the nearest pixel outside the region."""

def gray_histogram(region: Region, image: Union[Frame, NDArray[Any]]) -> NDArray[numpy.int64]:
    """(256,) numbers of the region's pixels with each value of a gray image, or brightness of a frame."""

def gray_features(region: Region, image: Union[Frame, NDArray[Any]]) -> Dict[str, Any]:
    """count, mean, deviation, min, max, median, entropy of the region's pixels."""

def gray_quantile(region: Region, image: Union[Frame, NDArray[Any]], share: float) -> int:
    """The smallest value that at least this share of the region's pixels does not exceed."""

def gray_moments(region: Region, image: Union[Frame, NDArray[Any]]) -> Dict[str, Any]:
    """Moments with each pixel weighted by its value: volume, column, row, rr, rc, cc, ra, rb, phi."""

def read_png_region(path: Union[str, os.PathLike[str]]) -> Region:
    """The pixels of a gray PNG that are not 0."""

def write_png_region(path: Union[str, os.PathLike[str]], region: Region, window: Tuple[int, int, int, int]) -> None:
    """Writes a mask of the window, 255 in the region."""

def coco_json(region: Region, width: int, height: int, counts: str = 'string') -> str:
    """The region as a COCO mask of an image of this size: run lengths as a 'string' or a 'list', in JSON."""

def region_from_coco_json(text: str) -> Region:
    """The region of such a text."""

def read_coco_masks(path: Union[str, os.PathLike[str]]) -> List[Region]:
    """The regions of a file with a JSON list of COCO masks."""

def write_coco_masks(path: Union[str, os.PathLike[str]], regions: List[Region], width: int, height: int, counts: str = 'string') -> None:
    """Writes regions of an image of this size as a JSON list of COCO masks."""

class Frame:
    """One camera image in a camera's own YUV layout, with what is known about it.

    The pixels stay in the arrays, which the frame keeps alive and nobody should change while it is used; rows may be
    anywhere, but must not have gaps. range is 'limited' or 'full', t the capture time in seconds."""
    @staticmethod
    def yuyv(array: NDArray[Any], *, range: Literal['limited', 'full'] = 'limited', t: float = 0.0, index: int = 0, image: str = '') -> Frame:
        """Packed Y U Y V: (height, width, 2), even width."""
    @staticmethod
    def uyvy(array: NDArray[Any], *, range: Literal['limited', 'full'] = 'limited', t: float = 0.0, index: int = 0, image: str = '') -> Frame:
        """Packed U Y V Y: (height, width, 2), even width."""
    @staticmethod
    def yuv422p(y: NDArray[Any], u: NDArray[Any], v: NDArray[Any], *, range: Literal['limited', 'full'] = 'limited', t: float = 0.0, index: int = 0, image: str = '') -> Frame:
        """Planes (height, width), and twice (height, width / 2, rounded up)."""
    @staticmethod
    def yuv420p(y: NDArray[Any], u: NDArray[Any], v: NDArray[Any], *, range: Literal['limited', 'full'] = 'limited', t: float = 0.0, index: int = 0, image: str = '') -> Frame:
        """Planes (height, width), and twice (height / 2, width / 2), rounded up."""
    @staticmethod
    def nv12(y: NDArray[Any], uv: NDArray[Any], *, range: Literal['limited', 'full'] = 'limited', t: float = 0.0, index: int = 0, image: str = '') -> Frame:
        """Planes (height, width) and (height / 2, width / 2, 2), rounded up; the latter may have two dimensions."""
    @staticmethod
    def rgb(array: NDArray[Any], *, range: Literal['limited', 'full'] = 'limited', t: float = 0.0, index: int = 0, image: str = '') -> Frame:
        """(height, width, 3) of R, G, B, converted to BT.601 in the range, chroma averaged over pairs of columns."""
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def format(self) -> str: ...
    @property
    def range(self) -> Literal['limited', 'full']:
        """'limited' or 'full'."""
    @property
    def t(self) -> float:
        """Capture time on the source's clock [s]."""
    @property
    def index(self) -> int:
        """0-based position in the source."""
    @property
    def image(self) -> str:
        """File name of a single image, else ''."""
    def to_yuv(self) -> NDArray[numpy.uint8]:
        """A (height, width, 3) copy with Y, U, V of every pixel."""
    def to_rgb(self) -> NDArray[numpy.uint8]:
        """A (height, width, 3) copy in R, G, B."""

class FrameSource:
    """An iterator over the frames of a video; see open_source."""
    def __iter__(self) -> FrameSource: ...
    def __next__(self) -> Frame: ...
    @property
    def name(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def range(self) -> Literal['limited', 'full']: ...
    @property
    def frame_count(self) -> Optional[int]:
        """As far as the container tells, else None."""

def open_source(location: Union[str, os.PathLike[str]], images_range: Literal['limited', 'full'] = 'limited') -> FrameSource:
    """The frames of a video or image file, a folder of images or a URL; RGB images become BT.601 in images_range."""

def read_png(path: Union[str, os.PathLike[str]]) -> NDArray[numpy.uint8]:
    """Any PNG as (height, width, 3) of R, G, B."""

def write_png(path: Union[str, os.PathLike[str]], image: NDArray[Any]) -> None:
    """Writes (height, width) gray values or (height, width, 3) of R, G, B."""

def boundary_contours(region: Region) -> List[Any]:
    """All borders of a region through its border pixels, one step a point: (points, is_hole), points (N, 2) of column, row; all are closed."""

def skeleton_contours(skeleton: Region, min_points: int = 1) -> Dict[str, Any]:
    """A skeleton taken apart: contours (points, closed, from and to: the junctions at its ends or -1), junctions (column, row, pixels), ends (N, 2)."""

def sub_pixel_edges(frame: Frame, region: Region, filter_size_px: int = 5, low: float = 4.0, high: float = 8.0, min_points: int = 5) -> List[Tuple[NDArray[numpy.float64], bool]]:
    """Edges of a frame's brightness inside a region: (points, closed), points (N, 2) of column, row between pixels, the brighter side to the right; filter_size_px 3, 5 or 7, low and high [gray levels / px]."""

class ColorTable:
    """Which colors are which class; never changed.

    A pixel (Y, U, V) belongs to a class when chroma[V, U] has the class's bit (1 black, 2 white, 4 green, ... 128 yellow)
    and Y lies in its brightness interval; of several such classes the first in `priority` wins."""
    def __init__(self, chroma: NDArray[Any], brightness: Dict[str, Tuple[int, int]], range: Literal['limited', 'full'] = 'limited', priority: Optional[List[str]] = None) -> None:
        """From a (256, 256) uint8 array of class bits, and closed brightness intervals by class name."""
    @staticmethod
    def load(path: Union[str, os.PathLike[str]]) -> ColorTable:
        """Reads colors.yaml and its PNG."""
    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes colors.yaml, and its PNG beside it."""
    @property
    def chroma(self) -> NDArray[numpy.uint8]:
        """(256, 256) class bits by [V, U]; read-only, without a copy."""
    @property
    def brightness(self) -> Dict[str, Any]:
        """Closed intervals (low, high) by class name."""
    @property
    def range(self) -> Literal['limited', 'full']:
        """The color range of the frames it was trained for."""
    @property
    def priority(self) -> List[str]:
        """All 8 class names; the first wins."""
    @property
    def trained_from(self) -> object:
        """samples, date, notes and quality (precision and recall by class name), or None."""
    def classify(self, y: int, u: int, v: int) -> str:
        """The class name of one pixel, or 'no_color'."""
    def __eq__(self, other: object) -> bool: ...

class Segmentation:
    """One region per color class for one frame: segmentation['red']. See segment."""
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def labels(self) -> NDArray[numpy.uint8]:
        """(height, width) of labels 0..8: no_color, black, white, green, blue, cyan, magenta, red, yellow; read-only, without a copy."""
    @property
    def regions(self) -> Dict[str, Region]:
        """The regions by class name."""
    def __getitem__(self, color: str) -> Region: ...

def segment(frame: Frame, colors: ColorTable) -> Segmentation:
    """Classifies every pixel of a frame and run-length encodes at once."""

def segment_opened(frame: Frame, colors: ColorTable) -> Segmentation:
    """The same with every region opened by 3 x 3 pixels: single odd pixels become no_color."""

def opening3x3(segmentation: Segmentation) -> Segmentation:
    """Opens every region of a segmentation by 3 x 3 pixels, as segment_opened does on the way."""

def train_colors(samples: object, held_out: object = None, images_range: Literal['limited', 'full'] = 'limited', options: Dict[str, float] = {}) -> ColorTable:
    """A table from labelled regions: the path of a samples.yaml, or (frame, region, class name) tuples.

    Its trained_from says how good it is: on held_out, samples of the same kind, or cross-validated. RGB images that a file names become BT.601 in images_range. options: those of `tassilo train colors`, as closing_px."""

def color_quality(colors: ColorTable, samples: object) -> object:
    """How well a table names the pixels of samples, as train_colors takes them: precision and recall by class name;
    confusion[true, found] and overlap[true, also claimed by] in pixels, by labels 0..8."""

class Camera:
    """Lens and mount as camera.yaml says: pixel (column, row) to and from metres, robot frame."""
    @staticmethod
    def load(path: Union[str, os.PathLike[str]]) -> Camera:
        """Reads a camera.yaml."""
    @staticmethod
    def from_yaml(text: str) -> Camera:
        """From the text of such a file."""
    def to_yaml(self) -> str:
        """The text of such a file."""
    @property
    def name(self) -> str: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def mount(self) -> object:
        """x, y, z [m], roll, pitch, yaw [rad] in the robot frame, or None."""
    def project(self, x: float, y: float, z: float = 0.0) -> Optional[Tuple[float, float]]:
        """Pixel of a point in space, possibly outside the image; None when it cannot show."""
    def floor_point(self, column: float, row: float, height: float = 0.0) -> Optional[Tuple[float, float]]:
        """Where the pixel's ray meets the level plane at `height`; None where it does not."""

class Field:
    """The field of a league."""
    @staticmethod
    def load(name: str) -> Field:
        """A shipped field by its name (msl98, rcj_soccer, ...), or the path of a YAML file."""
    @staticmethod
    def from_yaml(text: str) -> Field:
        """From the text of such a file."""
    @property
    def name(self) -> str: ...
    @property
    def length(self) -> float:
        """[m]"""
    @property
    def width(self) -> float:
        """[m]"""
    @property
    def line_width(self) -> float:
        """[m]"""

class Vision:
    """The whole vision of one robot: vision(frame) is a scene.

    From parts: the color table and, for everything in metres, camera and field; each the object or the path of its file
    (field also the name of a shipped one). options: as below `vision:` in robot.yaml, see vision_options, and
    stages for those that are names."""
    def __init__(self, colors: object, camera: object = None, field: object = 'msl98', options: Dict[str, Any] = {}) -> None:
        """From parts."""
    @staticmethod
    def from_robot(path: Union[str, os.PathLike[str]], colors: Optional[Union[str, os.PathLike[str]]] = None) -> Vision:
        """From a robot.yaml and the files it names; `colors` takes the place of its color table."""
    def __call__(self, frame: Frame) -> Dict[str, Any]:
        """Sees one frame: a dict with the keys of a line of `tassilo run --output` (schema/scene.schema.json). Each frame is seen by itself: the pose is what it alone shows. Raises tassilo.Error for frames of another size or color range than camera and table are for."""
    def draw(self, frame: Frame, scene: Dict[str, Any], scale: int = 0, bird_view: bool = True) -> NDArray[numpy.uint8]:
        """The frame with what was seen in it, beside it the view from above: (height, width, 3) of R, G, B."""

def vision_options() -> List[Any]:
    """The options of Vision: key, default, low, high, whole, unit, meaning."""

def stages() -> List[Any]:
    """The stages of Vision in the order they run: key, meaning, options as in vision_options, and alternatives, the default first: name, meaning, options of their own. One is chosen by the option key=name."""
