// Entry point of the library: registers the classes with Godot.
#include <gdextension_interface.h>

#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/godot.hpp>

#include "godot/base/class_documentation.h"
#include "godot/calibration/spidar_g_calibrator.h"
#include "godot/device/spidar_g.h"
#include "godot/hand/spidar_g_hand.h"
#include "godot/settings/project_options.h"
#include "godot/settings/spidar_g_calibration.h"
#include "godot/settings/spidar_g_config.h"
#include "godot/surface/spidar_g_material.h"
#include "godot/surface/spidar_g_surface.h"
#include "godot/workspace/spidar_g_workspace.h"

namespace {

void initialize(godot::ModuleInitializationLevel level) {
    if (level == godot::MODULE_INITIALIZATION_LEVEL_SCENE) {
        GDREGISTER_CLASS(SpidarGConfig);
        GDREGISTER_CLASS(SpidarGCalibration);
        GDREGISTER_CLASS(SpidarGMaterial);
        GDREGISTER_CLASS(SpidarGSurface);
        GDREGISTER_CLASS(SpidarGCalibrator);
        GDREGISTER_CLASS(SpidarGWorkspace);
        GDREGISTER_CLASS(SpidarG);
        GDREGISTER_CLASS(SpidarGHand);
        spidar::register_project_options();
    }
    if (level == godot::MODULE_INITIALIZATION_LEVEL_EDITOR) {
        spidar::load_class_documentation();
    }
}

void terminate(godot::ModuleInitializationLevel /*level*/) {}

} // namespace

extern "C" GDE_EXPORT GDExtensionBool
spidar_g_library_init(GDExtensionInterfaceGetProcAddress get_proc_address,
                      GDExtensionClassLibraryPtr library, GDExtensionInitialization *result) {
    spidar::prepare_class_documentation(get_proc_address);
    godot::GDExtensionBinding::InitObject init_object(get_proc_address, library, result);
    init_object.register_initializer(initialize);
    init_object.register_terminator(terminate);
    init_object.set_minimum_library_initialization_level(godot::MODULE_INITIALIZATION_LEVEL_SCENE);
    return init_object.init();
}
