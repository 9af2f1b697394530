"""Color vision for robots, and region processing in the style of HALCON: see docs/python.md."""
from . import _tassilo
from ._tassilo import *

__version__ = _tassilo.__version__
__all__ = [name for name in vars(_tassilo) if not name.startswith("_")]
