#include "sim/probe/probe.h"
