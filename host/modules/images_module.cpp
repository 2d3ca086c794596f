#include <vitrail/version.h>

#include "modules/modules.h"

extern "C" const vitrail::io_detail::ImagesModule vitrail_images{VITRAIL_VERSION, vitrail::io_detail::decodeImage,
                                                                 vitrail::io_detail::encodeExr, vitrail::io_detail::encodePng};
