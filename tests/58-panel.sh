# The panel in small: its starred lines against their limits, without truths by paths.
CHECK=yes exec sh tests/panel/panel.sh
