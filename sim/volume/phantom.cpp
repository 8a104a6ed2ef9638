#include "sim/volume/phantom.h"
