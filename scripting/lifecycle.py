"""How nodes enter, get ready, leave and end.

All walks are loops, so trees may be as deep as they like, and all of them go on sensibly when a
callback adds, moves, removes or frees nodes: what was added by a callback has entered and got ready
by the time `add_child` returns, and what is gone is skipped.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import IntEnum
from typing import TYPE_CHECKING

from .paths import unique_name
from .reports import FreedError, report
from .signals import BoundSignal, emit_if_made

if TYPE_CHECKING:
    from .node import Node
    from .tree import SceneTree

emit = emit_if_made


class ProcessMode(IntEnum):
    """When a node's callbacks run."""

    INHERIT = 0
    PAUSABLE = 1
    WHEN_PAUSED = 2
    ALWAYS = 3
    DISABLED = 4


def ancestors(node: Node) -> Iterator[Node]:
    """The parent, its parent, and so on."""
    above = node._parent
    while above is not None:
        yield above
        above = above._parent


def below(node: Node) -> Iterator[Node]:
    """All nodes below, parents before children, in tree order."""
    stack = [*reversed(node._children.values())]
    while stack:
        current = stack.pop()
        yield current
        if current._children:
            stack.extend(reversed(current._children.values()))


def outline(node: Node) -> Iterator[str]:
    """A line for each node, children indented."""
    base = sum(1 for _ in ancestors(node))
    for one in (node, *below(node)):
        depth = sum(1 for _ in ancestors(one)) - base
        yield f"{'  ' * depth}{one.name} ({type(one).__name__})"


def add(parent: Node, child: Node) -> None:
    """`Node.add_child`."""
    from .node import Node

    if not isinstance(child, Node):
        raise ValueError(f"child is {child!r}, expected a node")
    for node in (parent, child):
        if node._freed:
            raise FreedError(f"{node!r} can't be used any more")
    if child._parent is not None:
        raise ValueError(f"{child!r} has a parent, {child._parent!r}; remove it there or reparent")
    if child is parent or child.is_ancestor_of(parent):
        raise ValueError(f"{child!r} can't become a part of itself")
    if child._leaving or child._tree is not None:
        raise ValueError(f"{child!r} is leaving the tree just now; use call_deferred")
    name = unique_name(child.name, parent)
    child._name = name
    child._parent = parent
    parent._children[name] = child
    child._parent_changed()
    if parent._tree is not None and not parent._leaving:
        enter(child, parent._tree)
        if parent._ready_begun and child._parent is parent:
            make_ready(child)


def remove(parent: Node, child: Node) -> None:
    """`Node.remove_child`."""
    if child._parent is not parent:
        raise ValueError(f"{child!r} is no child of {parent!r}")
    if child._tree is not None and not child._leaving:
        leave(child)
        if child._parent is not parent:
            return  # a callback took it out already
    del parent._children[child._name]
    child._parent = None
    child._parent_changed()
    inside = {id(child), *(id(node) for node in below(child))}
    for node in (child, *below(child)):
        if node._owner is not None and id(node._owner) not in inside:
            node.owner = None


def reparent(node: Node, parent: Node) -> None:
    """`Node.reparent`."""
    old = node._parent
    if old is None:
        raise ValueError(f"{node!r} has no parent; use add_child")
    if parent is node or node.is_ancestor_of(parent) or parent._freed:
        raise ValueError(f"parent is {parent!r}, expected a node that is no part of {node!r}")
    if parent is old:
        return
    keep = [(one, one._owner) for one in (node, *below(node)) if one._owner is not None]
    remove(old, node)
    node._parent = parent  # for a moment, to see which owners are still above
    owners = [(one, owner) for one, owner in keep if owner.is_ancestor_of(one)]
    node._parent = None
    add(parent, node)
    for one, owner in owners:
        if owner.is_ancestor_of(one):
            one.owner = owner


def enter(top: Node, tree: SceneTree) -> None:
    """Let a subtree enter, parents before children."""
    stack = [top]
    while stack:
        node = stack.pop()
        parent = node._parent
        if node._tree is not None or parent is None or parent._tree is not tree:
            continue  # it entered, or was taken out, in a callback
        node._tree = tree
        _take_mode(node, parent, tree)
        for group in node._groups:
            tree.groups.join(node, group)
        tree.order.added(node)
        if "process_priority" in node.__dict__:
            tree.order.prioritised = True
        node._entered()
        guard(tree, node, "_enter_tree")
        emit(node, "tree_entered")
        emit(tree, "node_added", node)
        if node._tree is tree and not node._leaving:
            stack.extend(reversed(node._children.values()))


def make_ready(top: Node) -> None:
    """Call `_ready` in a subtree, children before parents, each once in its life."""
    top._ready_begun = True
    stack = [(top, iter(top.children))]
    while stack:
        node, rest = stack[-1]
        child = next(rest, None)
        if child is not None:
            if child._parent is node and child._tree is not None and not child._ready_begun:
                child._ready_begun = True
                stack.append((child, iter(child.children)))
            continue
        stack.pop()
        if node._tree is not None and not node._leaving and node._needs_ready:
            node._needs_ready = False
            node._made_ready()
            guard(node._tree, node, "_ready")
            emit(node, "ready")


def leave(top: Node) -> None:
    """Let a subtree leave its tree, the last children first, children before parents."""
    tree = top._tree
    assert tree is not None
    nodes = [node for node in (top, *below(top)) if node._tree is tree and not node._leaving]
    for node in nodes:
        node._leaving = True
    nodes.reverse()
    for node in nodes:
        guard(tree, node, "_exit_tree")
        emit(node, "tree_exiting")
    for node in nodes:
        node._can_process = False
        node._process_on = node._physics_on = node._step_on = False
        node._input_on = node._unhandled_on = False
        node._ready_begun = False
        tree.order.resting.add(node)
        for group in node._groups:
            tree.groups.leave(node, group)
        node._tree = None
        node._leaving = False
    tree.order.removed(nodes)
    for node in nodes:
        node._has_left(freed=False)
        emit(tree, "node_removed", node)
        emit(node, "tree_exited")


def free(top: Node) -> None:
    """`Node.free`."""
    if top._freed:
        return
    if top._tree is not None and top._tree.root is top:
        raise ValueError("the root of a tree can't be freed; use SceneTree.close")
    if top._leaving:
        raise ValueError(f"{top!r} is leaving the tree just now; use queue_free")
    if top._parent is not None:
        remove(top._parent, top)
    end(top)


def end(top: Node) -> None:
    """Cut everything that reaches into or out of a subtree that is in no tree any more."""
    nodes = [top, *below(top)]
    for node in nodes:
        node._freed = node._queued = True
    for node in reversed(nodes):
        node._has_left(freed=True)
        for task in [*node._tasks]:
            task.cancel()
        for connection in [*node._incoming]:
            connection.signal.drop(connection)
        for value in [*node.__dict__.values()]:
            if isinstance(value, BoundSignal):
                value.close()
    for node in reversed(nodes):
        node._owner = node._parent = None
        node._children, node._uniques = {}, {}


def guard(tree: SceneTree, node: Node, callback: str) -> None:
    """Call a callback; what it raises is reported, a coroutine that it gives is run."""
    function = getattr(node, callback)
    try:
        result = function()
    except Exception as error:
        report(error, function, "", node if node._tree is not None else tree)
    else:
        if result is not None:
            tree.run_if_coroutine(result, node)


def refresh_modes(top: Node) -> None:
    """A process mode or the pause changed: see what may run in a subtree now."""
    tree = top._tree
    if tree is None:
        return
    for node in (top, *below(top)):
        if node._tree is tree:
            _take_mode(node, node._parent, tree)


def refresh_flags(node: Node) -> None:
    """See which of a node's callbacks run now."""
    can, has, wants = node._can_process, node._overrides, node._wants
    node._process_on = can and "_process" in has and wants.get("_process", True)
    node._physics_on = can and "_physics_process" in has and wants.get("_physics_process", True)
    node._input_on = can and "_input" in has and wants.get("_input", True)
    node._unhandled_on = can and "_unhandled_input" in has and wants.get("_unhandled_input", True)
    node._step_on = can and "_step" in has
    if node._tree is not None:
        rests = ("_process" in has and not node._process_on) or (
            "_physics_process" in has and not node._physics_on
        )
        (node._tree.order.resting.add if rests else node._tree.order.resting.discard)(node)


def forget_unique(node: Node) -> None:
    """A node's name, owner or uniqueness is about to change."""
    owner = node._owner
    if owner is not None and owner._uniques.get(node.name) is node:
        del owner._uniques[node.name]


def note_unique(node: Node) -> None:
    """Let ``%Name`` find a node if it wants that; the first of a name stays."""
    if node._unique and node._owner is not None:
        node._owner._uniques.setdefault(node.name, node)


def _take_mode(node: Node, parent: Node | None, tree: SceneTree) -> None:
    mode = node.__dict__.get("process_mode", ProcessMode.INHERIT)
    if mode is ProcessMode.INHERIT:
        mode = ProcessMode.PAUSABLE if parent is None else parent._mode
    node._mode = mode
    node._can_process = (
        mode is ProcessMode.ALWAYS
        or (mode is ProcessMode.PAUSABLE and not tree.paused)
        or (mode is ProcessMode.WHEN_PAUSED and tree.paused)
    )
    refresh_flags(node)
