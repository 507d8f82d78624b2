# What others build on: find_package(gridmerge) gives the libraries, `gridmerge::core` and so on.
include(CMakePackageConfigHelpers)

set(gridmerge_headers ${CMAKE_INSTALL_INCLUDEDIR}/gridmerge)
set(gridmerge_package ${CMAKE_INSTALL_LIBDIR}/cmake/gridmerge)

install(TARGETS gridmerge_core gridmerge_config gridmerge_map_server gridmerge_methods gridmerge_plugin gridmerge_cli
        EXPORT gridmergeTargets
        INCLUDES DESTINATION ${gridmerge_headers})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/core/gridmerge/ DESTINATION ${gridmerge_headers}
        FILES_MATCHING PATTERN *.hpp)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/adapters/config ${PROJECT_SOURCE_DIR}/adapters/map_server
        DESTINATION ${gridmerge_headers}/adapters
        FILES_MATCHING PATTERN *.hpp)
install(FILES ${PROJECT_SOURCE_DIR}/adapters/plugin/method_plugin.hpp DESTINATION ${gridmerge_headers}/adapters/plugin)
install(FILES ${PROJECT_SOURCE_DIR}/methods/register_all.hpp DESTINATION ${gridmerge_headers}/methods)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT gridmergeTargets NAMESPACE gridmerge:: DESTINATION ${gridmerge_package})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/gridmergeConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/gridmergeConfig.cmake
                              INSTALL_DESTINATION ${gridmerge_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gridmergeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gridmergeConfig.cmake ${PROJECT_BINARY_DIR}/gridmergeConfigVersion.cmake
        DESTINATION ${gridmerge_package})
