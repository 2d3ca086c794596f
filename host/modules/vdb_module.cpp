#include <vitrail/version.h>

#include "modules/modules.h"

extern "C" const vitrail::io_detail::VdbModule vitrail_vdb{VITRAIL_VERSION, vitrail::saveVdb, vitrail::saveVdbCells, vitrail::loadVdb,
                                                           vitrail::loadVdbCells};
