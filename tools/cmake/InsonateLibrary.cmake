# The simulator as an installed library: find_package(insonate) gives insonate::sim and each room of sim. Headers are in
# include/insonate, so that they include each other as in the sources: "sim/core/pose.h". The component `development`
# holds all of it, and the component `assets` the tissue table and the built-in patient.
include(CMakePackageConfigHelpers)

set(library_folder "${CMAKE_INSTALL_LIBDIR}/cmake/insonate")
set(rooms core files image_headers volume phantom probe acoustics reconstruction tissue model reference truth shaders gl
          imaging wein registration view)
foreach(room IN LISTS rooms)
  set_target_properties(insonate_${room} PROPERTIES EXPORT_NAME ${room})
  target_include_directories(insonate_${room} INTERFACE "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/insonate>")
  target_compile_features(insonate_${room} INTERFACE cxx_std_20)
  list(APPEND library_targets insonate_${room})
endforeach()
set_target_properties(insonate_sim PROPERTIES EXPORT_NAME sim)
install(TARGETS ${library_targets} insonate_sim EXPORT insonate
        ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
install(EXPORT insonate NAMESPACE insonate:: FILE insonate-targets.cmake DESTINATION "${library_folder}"
        COMPONENT development)
install(DIRECTORY "${CMAKE_SOURCE_DIR}/sim" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/insonate" COMPONENT development
        FILES_MATCHING PATTERN "*.h")
set(insonate_assets "${CMAKE_INSTALL_DATADIR}/insonate")
configure_package_config_file("${CMAKE_SOURCE_DIR}/tools/cmake/insonate-config.cmake.in"
                              "${CMAKE_BINARY_DIR}/insonate-config.cmake" INSTALL_DESTINATION "${library_folder}"
                              PATH_VARS insonate_assets)
# The headers may change with the second number until the first is 1 (CHANGELOG.md).
write_basic_package_version_file("${CMAKE_BINARY_DIR}/insonate-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/insonate-config.cmake" "${CMAKE_BINARY_DIR}/insonate-config-version.cmake"
        DESTINATION "${library_folder}" COMPONENT development)
