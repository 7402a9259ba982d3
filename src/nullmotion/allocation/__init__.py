"""Allocation by quadratic programs: the parts that laws with a horizon are made of.

`blocks` is the source of a problem's matrices, `compiled` its machine code, `problem` what the
solver gets, `exclusion` the singular configuration to stay away from, `limits` what gimbals can
do, `fallback` what happens without a solution.
"""
