#include "sim/reference/reference.h"
