"""The pictures of the pages in docs/, made from real objects: ``make pictures``.

Each function of `PICTURES` returns the pixels of one file. They lie beside the benchmarks since
they may use all of the package, and nothing of it uses them.
"""
