# The panel in small: its starred lines against their limits, with truths by paths only
# where a claim is held against them.
CHECK=yes exec sh tests/panel/panel.sh
