"""Nodes: the tree that a game is made of, with Godot's callbacks."""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Coroutine, Iterable, Iterator
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, overload

from . import lifecycle
from .exports import Export, Exported, export
from .lifecycle import ProcessMode
from .order import CALLBACKS
from .paths import NodePathError, check_name, find, path_between, unique_name
from .reports import FreedError
from .signals import Connection, Signal

if TYPE_CHECKING:
    from .input_events import InputEvent
    from .tasks import Task
    from .tree import SceneTree
    from .tween import Tween

N = TypeVar("N", bound="Node")


class Node(Exported):
    """A part of a game: has a name, a parent, children, and callbacks that subclasses override.

    A subclass is made with keyword arguments for its exports and other annotated attributes, and
    for `name`, `process_mode` and `process_priority`.

    Attributes
    ----------
    name
        Unique among its siblings: a number is added where it isn't. Its class's name at first.
    process_mode
        Whether callbacks run, stop in pauses, or run in pauses only; `INHERIT` asks the parent.
    process_priority
        Nodes of lower numbers are processed first.
    scene_path
        The scene file that the node is the root of; empty otherwise.
    """

    ready = Signal[()]()
    """After `_ready`."""
    tree_entered = Signal[()]()
    tree_exiting = Signal[()]()
    """While it is still inside."""
    tree_exited = Signal[()]()
    renamed = Signal[()]()

    if TYPE_CHECKING:
        name: str = export(default="")
    process_mode: ProcessMode = export(
        default=ProcessMode.INHERIT, group="Process", changed="_mode_changed"
    )
    process_priority: int = export(default=0, group="Process", changed="_priority_changed")

    _overrides: ClassVar[frozenset[str]] = frozenset()
    _accepted: ClassVar[frozenset[str]] = frozenset({"name"})

    def __new__(cls, *args: Any, **kwargs: Any) -> Any:
        """Make an object with its state, before its `__init__`."""
        # Here and not in __init__, so that a subclass may forget to call it.
        node = super().__new__(cls)
        node._prepare()
        return node

    def _prepare(self) -> None:
        self._name = ""
        self._parent: Node | None = None
        self._children: dict[str, Node] = {}
        self._suffixes: dict[str, int] = {}
        self._tree: SceneTree | None = None
        self._owner: Node | None = None
        self._unique = False
        self._uniques: dict[str, Node] = {}
        self._groups: dict[str, None] = {}
        self._incoming: dict[Connection, None] = {}
        self._tasks: dict[Task, None] = {}
        self._wants: dict[str, bool] = {}
        self._mode = ProcessMode.INHERIT
        self._can_process = self._process_on = self._physics_on = False
        self._input_on = self._unhandled_on = self._step_on = False
        self._needs_ready, self._ready_begun = True, False
        self._leaving = self._queued = self._freed = False
        self._position_in_tree = 0.0
        self.scene_path = ""

    def __init_subclass__(cls, **arguments: Any) -> None:
        """Note what a new class declares."""
        super().__init_subclass__(**arguments)
        for name, value in [*cls.__dict__.items(), *((field, None) for field in cls._fields)]:
            known = getattr(Node, name, None) if not name.startswith("_") else None
            if known is None or isinstance(known, Export) or name == "name":
                continue
            if value is None or isinstance(value, (Export, Signal)):
                raise ValueError(f"{cls.__name__}.{name}: '{name}' is a name that Node uses")
        cls._overrides = frozenset(
            name for name in CALLBACKS if getattr(cls, name) is not getattr(Node, name)
        )

    def __repr__(self) -> str:
        """For messages."""
        return f"<{type(self).__name__} {self.path}{' (freed)' if self._freed else ''}>"

    # What subclasses override. Each may be an ``async def``.

    def _enter_tree(self) -> Any:
        """Has entered the tree; parents before children."""

    def _ready(self) -> Any:
        """Is in the tree for the first time, and its children are ready."""

    def _process(self, delta: float) -> Any:
        """Once a frame; `delta` seconds since the last."""

    def _physics_process(self, delta: float) -> Any:
        """Once a tick, 60 times a second, before the frame's `_process`."""

    def _input(self, event: InputEvent) -> Any:
        """Something was pressed, moved or released; the last nodes of the tree first."""

    def _unhandled_input(self, event: InputEvent) -> Any:
        """The same, if no `_input` called `SceneTree.set_input_as_handled`."""

    def _exit_tree(self) -> Any:
        """Is about to leave the tree; children before parents."""

    def _step(self, delta: float, *, physics: bool) -> None:
        """What node types of this package do before the callbacks, in frames and in ticks."""

    def _parent_changed(self) -> None:
        """What node types of this package do when they got or lost a parent."""

    def _made_ready(self) -> None:
        """What node types of this package do just before `_ready`."""

    def _sources(self) -> Iterable[tuple[str, Callable[[], object]]]:
        """Files that node types of this package were made from, and what to do when they change."""
        return ()

    def _entered(self) -> None:
        """What node types of this package do when they enter a tree, before `_enter_tree`."""

    def _has_left(self, *, freed: bool) -> None:
        """What node types of this package do after they left a tree, or were freed."""

    # Names and places

    if not TYPE_CHECKING:

        @property
        def name(self) -> str:
            """Its name."""
            return self._name or type(self).__name__

        @name.setter
        def name(self, name: str) -> None:
            if self._freed:
                raise FreedError(f"{self!r} can't be renamed")
            wanted, parent = check_name(name), self._parent
            if wanted == self._name:
                return
            if parent is None:
                self._name = wanted
                lifecycle.emit(self, "renamed")
                return
            lifecycle.forget_unique(self)
            old, new = self._name, unique_name(wanted, parent)
            parent._children = {
                new if key == old else key: child for key, child in parent._children.items()
            }
            self._name = new
            lifecycle.note_unique(self)
            lifecycle.emit(self, "renamed")

    @property
    def path(self) -> str:
        """``/root/Main/Crowd``; outside a tree the names from its top on."""
        names = [self.name]
        node = self._parent
        while node is not None:
            names.append(node.name)
            node = node._parent
        return ("/" if self._tree is not None else "") + "/".join(reversed(names))

    @property
    def parent(self) -> Node | None:
        """The node that it is a child of."""
        return self._parent

    @property
    def children(self) -> tuple[Node, ...]:
        """Its children in order."""
        return tuple(self._children.values())

    def get_child(self, index: int) -> Node:
        """The child at `index`; negative ones count from the end."""
        return self.children[index]

    @property
    def index(self) -> int:
        """Its place among its siblings; 0 without a parent."""
        return 0 if self._parent is None else self._parent.children.index(self)

    @property
    def tree(self) -> SceneTree:
        """The tree that it is inside of; ValueError if it is in none."""
        if self._tree is None:
            raise ValueError(f"{self!r} is not inside a tree")
        return self._tree

    def is_inside_tree(self) -> bool:
        """Whether it is."""
        return self._tree is not None

    def is_ancestor_of(self, node: Node) -> bool:
        """Whether `node` is its child, or a child's child, and so on."""
        return any(above is self for above in lifecycle.ancestors(node))

    @property
    def owner(self) -> Node | None:
        """Root of the scene that it belongs to; must be above it."""
        return self._owner

    @owner.setter
    def owner(self, owner: Node | None) -> None:
        if owner is not None and not owner.is_ancestor_of(self):
            raise ValueError(f"owner is {owner!r}, expected a node above {self!r}")
        lifecycle.forget_unique(self)
        self._owner = owner
        lifecycle.note_unique(self)

    @property
    def unique_name_in_owner(self) -> bool:
        """Whether ``%Name`` finds it from every node of its scene."""
        return self._unique

    @unique_name_in_owner.setter
    def unique_name_in_owner(self, unique: bool) -> None:
        lifecycle.forget_unique(self)
        self._unique = bool(unique)
        lifecycle.note_unique(self)

    # Children

    def add_child(self, child: N) -> N:
        """Make `child` the last child and return it; in a tree it enters and gets ready at once.

        Raises
        ------
        ValueError
            If it has a parent already, or would become a part of itself.
        """
        lifecycle.add(self, child)
        return child

    def remove_child(self, child: Node) -> None:
        """Take `child` out; it isn't freed and can be added again. ValueError if it is no child."""
        lifecycle.remove(self, child)

    def move_child(self, child: Node, index: int) -> None:
        """Put `child` at `index` among its siblings; negative ones count from the end."""
        if child._parent is not self:
            raise ValueError(f"{child!r} is no child of {self!r}")
        count = len(self._children)
        if not -count <= index < count:
            raise ValueError(f"index is {index}, expected {-count} to {count - 1}")
        rest = [node for node in self._children.values() if node is not child]
        rest.insert(index % count, child)
        self._children = {node.name: node for node in rest}
        self._order_changed()

    def reparent(self, parent: Node, *, keep_global_transform: bool = True) -> None:
        """Move to another parent, leaving and entering the tree; keeps its owner if that is above.

        `keep_global_transform` matters to nodes that have one.
        """
        lifecycle.reparent(self, parent)

    def find_child(self, pattern: str, *, recursive: bool = True) -> Node | None:
        """The first node below whose name fits a pattern with ``*`` and ``?``."""
        for node in lifecycle.below(self) if recursive else iter(self.children):
            if fnmatch.fnmatchcase(node.name, pattern):
                return node
        return None

    # Paths

    @overload
    def get_node(self, path: str) -> Node: ...
    @overload
    def get_node(self, path: str, kind: type[N]) -> N: ...
    def get_node(self, path: str, kind: type[Node] | None = None) -> Node:
        """The node at a path such as ``"../Crowd/North"``, ``"%Ball"`` or ``"/root/Main"``.

        Raises
        ------
        NodePathError
            (a KeyError) If there is none.
        TypeError
            If it is not of the class `kind`.
        """
        node, reason = find(self, path)
        if node is None:
            raise NodePathError(f"no node at '{path}' from {self.path}: {reason}")
        if kind is not None and not isinstance(node, kind):
            raise TypeError(f"{node!r} at '{path}' is no {kind.__name__}")
        return node

    def __getitem__(self, path: str) -> Node:
        """``node["../Crowd"]``: the same as `get_node`."""
        return self.get_node(path)

    def get_node_or_none(self, path: str) -> Node | None:
        """The node at a path, or None."""
        return find(self, path)[0]

    def has_node(self, path: str) -> bool:
        """Whether there is a node at a path."""
        return find(self, path)[0] is not None

    def path_to(self, node: Node) -> str:
        """The path that leads from here to `node`."""
        return path_between(self, node)

    # Groups

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups that it is in."""
        return tuple(self._groups)

    def add_to_group(self, group: str) -> None:
        """Join a group, which `SceneTree.call_group` calls."""
        if not isinstance(group, str) or not group:
            raise ValueError(f"group is {group!r}, expected a text")
        self._groups[group] = None
        if self._tree is not None:
            self._tree.groups.join(self, group)

    def remove_from_group(self, group: str) -> None:
        """Leave a group; nothing happens if it isn't in it."""
        self._groups.pop(group, None)
        if self._tree is not None:
            self._tree.groups.leave(self, group)

    def is_in_group(self, group: str) -> bool:
        """Whether it is in a group."""
        return group in self._groups

    # Processing

    def set_process(self, enabled: bool) -> None:
        """Whether `_process` is called."""
        self._wants["_process"] = bool(enabled)
        lifecycle.refresh_flags(self)

    def set_physics_process(self, enabled: bool) -> None:
        """Whether `_physics_process` is called."""
        self._wants["_physics_process"] = bool(enabled)
        lifecycle.refresh_flags(self)

    def set_process_input(self, enabled: bool) -> None:
        """Whether `_input` is called."""
        self._wants["_input"] = bool(enabled)
        lifecycle.refresh_flags(self)

    def set_process_unhandled_input(self, enabled: bool) -> None:
        """Whether `_unhandled_input` is called."""
        self._wants["_unhandled_input"] = bool(enabled)
        lifecycle.refresh_flags(self)

    def can_process(self) -> bool:
        """Whether it is inside a tree and its process mode lets its callbacks run now."""
        return self._can_process

    def request_ready(self) -> None:
        """Call `_ready` once more when it enters a tree the next time."""
        self._needs_ready = True

    def is_node_ready(self) -> bool:
        """Whether `_ready` was called."""
        return not self._needs_ready

    def _mode_changed(self) -> None:
        if self._tree is not None:
            lifecycle.refresh_modes(self)

    def _priority_changed(self) -> None:
        if self._tree is not None:
            self._tree.order.prioritised = True
            self._tree.order.changed()

    def _order_changed(self) -> None:
        if self._tree is not None:
            self._tree.order.changed()

    # Later, and the end

    def call_deferred(self, method: str | Callable[..., object], *args: Any) -> None:
        """Call a method when the tree flushes its deferred calls, after this round of callbacks."""
        function = getattr(self, method) if isinstance(method, str) else method
        self.tree.defer(function, *args, owner=self)

    def set_deferred(self, attribute: str, value: object) -> None:
        """Set an attribute when the tree flushes its deferred calls."""
        self.tree.defer(self.__setattr__, attribute, value, owner=self)

    def create_task(self, coroutine: Coroutine[Any, Any, Any]) -> Task:
        """Run a coroutine to its first await; signals resume it, `free` closes it."""
        return self.tree.start(coroutine, owner=self)

    def create_tween(self) -> Tween:
        """A tween that dies with this node and stands still while its callbacks do."""
        return self.tree.create_tween().bind_node(self)

    def queue_free(self) -> None:
        """Free at the end of this tick or frame; at once outside a tree."""
        if self._tree is None:
            self.free()
        elif not self._queued:
            self._queued = True
            self._tree.queue_delete(self)

    def is_queued_for_deletion(self) -> bool:
        """Whether `queue_free` was called."""
        return self._queued

    def free(self) -> None:
        """Leave the tree and end, with all children: signals are cut, coroutines closed."""
        lifecycle.free(self)

    def tree_text(self) -> str:
        """Names and classes of this node and those below, a line each, indented."""
        return "\n".join(lifecycle.outline(self))

    def __iter__(self) -> Iterator[Node]:
        """Its children; without this, ``node[...]`` would make it a sequence."""
        return iter(self.children)


def is_instance_valid(thing: object) -> bool:
    """Whether `thing` is an object that wasn't freed."""
    return thing is not None and not getattr(thing, "_freed", False)
