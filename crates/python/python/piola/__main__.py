"""`python -m piola` is the command `piola`."""

import sys

from ._program import main

sys.exit(main())
