"""Run the command line: python -m nullmotion."""

from nullmotion.cli import main

main()
