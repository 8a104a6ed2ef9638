#include "sim/volume/ct_reader.h"
