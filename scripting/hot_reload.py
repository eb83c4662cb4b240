"""Scripts, scenes and other files that change while the game runs are taken over.

Files are looked at twice a second: those that `load` read, imported modules below the resource
folder, and what nodes were made from (controllers, characters). The script that Python was started
with is left alone. Whatever can't be used is reported, and the game goes on with the old.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from time import monotonic
from types import ModuleType

from .class_patch import reload_module, revalidate
from .lifecycle import below, refresh_flags
from .node import Node
from .packed_scene import PackedScene
from .reports import report
from .resources import Resource, file_of, load, loaded_files, resource_path_of, resource_root
from .scene_patch import patch_instance
from .signals import Signal, emit_if_made
from .tree import SceneTree

SECONDS = 0.5
"""How often files are looked at."""

Stamp = tuple[int, int]


class HotReload:
    """Watches the files of a running game.

    State is kept where it can be. A script's classes stay the same objects and get the new
    methods, exports and signals, so nodes keep what they know, also in connections and scenes; an
    export whose value the new declaration doesn't take gets its default, which is reported. In a
    scene, what was changed in the file is changed in its running instances: exports are set, nodes
    are added, freed or, with another type, replaced. Resources keep their identity.

    Parameters
    ----------
    tree
        Of the game; gets the errors.

    Attributes
    ----------
    reloaded
        Emitted with the path of each file that was taken over.
    """

    reloaded = Signal[str]()

    def __init__(self, tree: SceneTree) -> None:
        self._tree = tree
        self._stamps: dict[Path, Stamp] = {}
        self._due = 0.0
        self._seen: list[Path] = []
        self._look()

    def poll(self) -> None:
        """Look at the files if that is due; cheap enough for every frame.

        What changed is taken over when the next tick begins.
        """
        now = monotonic()
        if now >= self._due:
            self._due = now + SECONDS
            changed = self._look()
            if changed and not self._seen:
                self._tree.at_next_tick(self._take_seen)
            self._seen += [file for file in changed if file not in self._seen]

    def check(self) -> list[str]:
        """Look at the files and take over what changed now; paths of what was taken over."""
        return self._take(self._look())

    def _take_seen(self) -> None:
        files, self._seen = self._seen, []
        self._take(files)

    def _take(self, files: list[Path]) -> list[str]:
        done: list[str] = []
        # Scripts first: a scene may use what they have now.
        for file in sorted(files, key=lambda file: (file.suffix != ".py", str(file))):
            path = resource_path_of(file)
            try:
                for take_over in self._takers(file):
                    take_over()
            except Exception as error:
                report(error, self.check, f"the change of '{path}'", self._tree)
                continue
            done.append(path)
        for path in done:
            self.reloaded.emit(path)
            emit_if_made(self._tree, "file_taken", path)
        return done

    def _look(self) -> list[Path]:
        """Files that changed since the last look."""
        changed = []
        for file in {*loaded_files(), *_modules(), *self._files_of_nodes()}:
            try:
                status = file.stat()
            except OSError:
                continue  # being written, or gone: what was loaded stays
            stamp = (status.st_mtime_ns, status.st_size)
            if self._stamps.setdefault(file, stamp) != stamp:
                self._stamps[file] = stamp
                changed.append(file)
        return changed

    def _takers(self, file: Path) -> Iterator[Callable[[], object]]:
        """What has to be done about a file."""
        held = loaded_files().get(file)
        module = held if isinstance(held, ModuleType) else _modules().get(file)
        if module is not None:
            yield lambda: self._take_script(module, file)
        elif isinstance(held, PackedScene):
            yield lambda: self._take_scene(held, file)
        elif isinstance(held, Resource):
            yield lambda: _take_resource(held, file)
        elif held is not None:
            yield lambda: load(file, fresh=True)
        for node in self._nodes():
            for path, taker in node._sources():
                if path and file_of(path) == file:
                    yield taker

    def _take_script(self, module: ModuleType, file: Path) -> None:
        classes = reload_module(module, file)
        gc.collect()  # the classes of the second run, which were only there to be copied
        wrong: list[Exception] = []
        for node in self._nodes():
            if isinstance(node, classes):
                wrong += revalidate(node)
                refresh_flags(node)
        for held in loaded_files().values():
            if isinstance(held, Resource) and isinstance(held, classes):
                wrong += revalidate(held)
        self._tree.order.changed()
        for error in wrong:
            report(error, self.check, f"the change of '{resource_path_of(file)}'", self._tree)

    def _take_scene(self, scene: PackedScene, file: Path) -> None:
        before = PackedScene(scene.path, scene.entries, scene.connections)
        fresh = load(file, fresh=True)
        loaded_files()[file] = scene
        if not isinstance(fresh, PackedScene):
            raise ValueError(f"{scene.path} is no scene any more")
        # Scenes that have this one inside hold the same object.
        object.__setattr__(scene, "entries", fresh.entries)
        object.__setattr__(scene, "connections", fresh.connections)
        for node in [node for node in self._nodes() if node.scene_path == scene.path]:
            if not node._freed:
                patch_instance(node, before, scene)

    def _nodes(self) -> list[Node]:
        return [*below(self._tree.root)]

    def _files_of_nodes(self) -> Iterator[Path]:
        for node in self._nodes():
            for path, _ in node._sources():
                if path:
                    yield file_of(path)


def _take_resource(held: Resource, file: Path) -> None:
    fresh = load(file, fresh=True)
    if type(fresh) is not type(held):
        raise ValueError(f"it holds a {type(fresh).__name__} now, and was a {type(held).__name__}")
    for name in type(held)._exports:
        setattr(held, name, getattr(fresh, name))
    loaded_files()[file] = held


def _modules() -> dict[Path, ModuleType]:
    """Imported modules below the resource folder, without tifo's own and the main one."""
    root, found = resource_root(), {}
    own = Path(__file__).resolve().parents[1]
    for name, module in [*sys.modules.items()]:
        text = getattr(module, "__file__", None)
        if name == "__main__" or not isinstance(text, str) or not text.endswith(".py"):
            continue
        file = Path(text)
        inside = file.is_relative_to(root) and not file.is_relative_to(own)
        if inside and "site-packages" not in file.parts and not name.startswith("tifo."):
            found[file] = module
    return found
