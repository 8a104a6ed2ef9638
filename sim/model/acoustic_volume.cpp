#include "sim/model/acoustic_volume.h"
