"""``python -m nullmotion.cli``."""

from nullmotion.cli import main

main()
