"""What the package does in Rust."""

from os import PathLike
from pathlib import Path
from typing import Any, Callable, Protocol, final, overload

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

Progress = Callable[[int, int], object]

__version__: str

class HasFaces(Protocol):
    @property
    def vertices(self) -> ArrayLike: ...
    @property
    def faces(self) -> ArrayLike: ...

class Hits:
    @property
    def verdict(self) -> NDArray[np.uint8]: ...
    @property
    def proof(self) -> NDArray[np.uint8]: ...
    @property
    def object(self) -> NDArray[np.int32]: ...
    @property
    def face(self) -> NDArray[np.int32]: ...
    @property
    def t(self) -> NDArray[np.float64]: ...
    @property
    def t_low(self) -> NDArray[np.float64]: ...
    @property
    def t_high(self) -> NDArray[np.float64]: ...
    @property
    def distance(self) -> NDArray[np.float64]: ...
    @property
    def point(self) -> NDArray[np.float64]: ...
    @property
    def normal(self) -> NDArray[np.float64]: ...
    @property
    def uv(self) -> NDArray[np.float64]: ...
    @property
    def coverage(self) -> NDArray[np.float64]: ...
    @property
    def surface(self) -> NDArray[np.int32]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> Hits: ...

@final
class Crossings(Hits):
    @property
    def ray(self) -> NDArray[np.int64]: ...
    @property
    def enters(self) -> NDArray[np.int8]: ...

@final
class Image:
    @property
    def array(self) -> NDArray[np.float64]: ...
    @property
    def depth(self) -> NDArray[np.float64] | None: ...
    @property
    def objects(self) -> NDArray[np.int32] | None: ...
    @property
    def normals(self) -> NDArray[np.float64] | None: ...
    @property
    def size(self) -> tuple[int, int]: ...
    def save(self, path: str | PathLike[str], *, dpi: int | None = None) -> None: ...
    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]: ...
    def _repr_png_(self) -> bytes: ...

@final
class Proof:
    @property
    def proven(self) -> NDArray[np.bool_]: ...
    @property
    def tie(self) -> NDArray[np.bool_]: ...
    @property
    def undecided(self) -> NDArray[np.bool_]: ...
    @property
    def contradicted(self) -> NDArray[np.bool_]: ...

@final
class Mesh:
    @property
    def is_closed(self) -> bool: ...
    @property
    def bounds(self) -> list[list[float]]: ...
    def hits(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        t_max: ArrayLike | None = None,
        *,
        leaves: Hits | None = None,
        fast: bool = False,
        tight: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Hits: ...
    def crossings(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        t_max: ArrayLike | None = None,
        *,
        tight: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Crossings: ...
    def occluded(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        t_max: ArrayLike | None = None,
        *,
        leaves: Hits | None = None,
        fast: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NDArray[np.bool_]: ...
    def inside(
        self, points: ArrayLike, *, threads: int | None = None, progress: Progress | None = None
    ) -> NDArray[np.int8]: ...

@final
class Scene:
    @property
    def has_camera(self) -> bool: ...
    @property
    def objects(self) -> list[str]: ...
    @property
    def size(self) -> tuple[int, int] | None: ...
    def render(
        self,
        *,
        samples: int | None = None,
        width: int | None = None,
        height: int | None = None,
        method: str | None = None,
        alpha: bool | None = None,
        depth: bool = False,
        objects: bool = False,
        normals: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Image: ...
    def hits(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        t_max: ArrayLike | None = None,
        *,
        leaves: Hits | None = None,
        fast: bool = False,
        tight: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Hits: ...
    def crossings(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        t_max: ArrayLike | None = None,
        *,
        tight: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Crossings: ...
    def occluded(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        t_max: ArrayLike | None = None,
        *,
        leaves: Hits | None = None,
        fast: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NDArray[np.bool_]: ...
    def verify(self, *, threads: int | None = None, progress: Progress | None = None) -> Proof: ...
    def _repr_png_(self) -> bytes | None: ...

def read(name: str, folder: Path, bytes: bytes, sets: list[str], is_written: bool) -> Scene: ...
def read_mesh(path: Path) -> Scene: ...
@overload
def mesh(vertices: ArrayLike, faces: ArrayLike, *, threads: int | None = None) -> Mesh: ...
@overload
def mesh(vertices: HasFaces, faces: None = None, *, threads: int | None = None) -> Mesh: ...
def tables() -> str: ...
