// Fuzzes the fits reader; see targets.cpp for what it demands.
#include "fuzz/entry.h"

ASTROSPLAT_FUZZ("fits")
