# What `cmake --install` puts in place: the headers, and per component its libraries with a targets file of its own, so that
# find_package(vitrail COMPONENTS core) looks for nothing but OpenCL and GLM however Vitrail itself was built.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/vitrail)

# vitrail_component(NAME parts...): skipped where its parts are not built.
function(vitrail_component name)
  list(TRANSFORM ARGN PREPEND vitrail_ OUTPUT_VARIABLE targets)
  list(GET targets 0 first)
  if(NOT TARGET ${first})
    return()
  endif()
  install(TARGETS ${targets} EXPORT vitrail-${name}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${name}
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT vitrail-${name} NAMESPACE vitrail:: DESTINATION ${package_folder} COMPONENT ${name})
endfunction()

vitrail_component(core core scene grid volume deform voxelize raster light metrics vitrail)
vitrail_component(vdb vdb)
vitrail_component(reference reference)
vitrail_component(io io files images)

install(DIRECTORY include/vitrail ${PROJECT_BINARY_DIR}/include/vitrail DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  COMPONENT core FILES_MATCHING PATTERN "*.h")
configure_package_config_file(third_party/vitrailConfig.cmake.in vitrailConfig.cmake INSTALL_DESTINATION ${package_folder})
# Before 1.0 every minor version may change the interface.
write_basic_package_version_file(vitrailConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vitrailConfig.cmake ${PROJECT_BINARY_DIR}/vitrailConfigVersion.cmake
  third_party/FindOpenImageIO.cmake third_party/FindOpenVDB.cmake third_party/embree_any.cmake
  DESTINATION ${package_folder} COMPONENT core)
if(TARGET vitrail)
  install(TARGETS vitrail RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(TARGETS ${VITRAIL_MODULES} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/vitrail COMPONENT program)
endif()
