"""Trace plain source to a tape of operations and compile the tape."""

from nullmotion.compile.function import CompiledFunction, compile_function
from nullmotion.compile.llvm import Host, host
from nullmotion.compile.program import Program, trace
from nullmotion.compile.tape import Symbol

__all__ = ["CompiledFunction", "Host", "Program", "Symbol", "compile_function", "host", "trace"]
