"""``python -m anistar.cli``."""

import sys

from .main import main

sys.exit(main())
