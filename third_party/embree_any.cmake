# Finds Embree 4 or 3 and names the target `embree`.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
