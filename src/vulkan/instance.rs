//! The Vulkan loader, the instance, and the validation layer with its messages.

use std::ffi::{CStr, CString, c_void};
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

use super::error::{VkContext, VulkanError};

/// The layer that checks every call against the specification.
pub(crate) const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";
/// Errors kept in full; later ones are only counted.
const KEPT_ERRORS: usize = 16;

/// Whether calls are checked by `VK_LAYER_KHRONOS_validation`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Validation {
    /// No checks: nothing is loaded, nothing costs time.
    #[default]
    Off,
    /// Check every call; an error stops the run.
    On {
        /// Fail with [`VulkanError::ValidationLayerMissing`] when the layer is not installed;
        /// otherwise warn and go on unchecked.
        required: bool,
        /// Check the ordering of reads and writes as well (slower).
        sync: bool,
    },
}

/// Validation errors collected until somebody asks.
#[derive(Default)]
pub(crate) struct Messages {
    errors: Mutex<(Vec<String>, usize)>,
}

impl Messages {
    fn record(&self, text: String) {
        let mut errors = self.errors.lock().unwrap_or_else(PoisonError::into_inner);
        errors.1 += 1;
        if errors.0.len() < KEPT_ERRORS {
            errors.0.push(text);
        }
    }

    /// Takes what was collected: `Err` if there was any error since the last call.
    pub(crate) fn check(&self) -> Result<(), VulkanError> {
        let mut errors = self.errors.lock().unwrap_or_else(PoisonError::into_inner);
        let (texts, count) = std::mem::take(&mut *errors);
        if count == 0 {
            return Ok(());
        }
        let mut line = texts.join(" | ");
        if count > texts.len() {
            line.push_str(&format!(" | and {} more", count - texts.len()));
        }
        Err(VulkanError::Validation(line))
    }
}

/// A Vulkan 1.3 instance with its messenger.
pub(crate) struct Instance {
    pub(crate) entry: ash::Entry,
    pub(crate) raw: ash::Instance,
    pub(crate) debug_utils: bool,
    pub(crate) validated: bool,
    pub(crate) messages: Arc<Messages>,
    messenger: Option<(ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
}

/// Opens the loader library.
pub(crate) fn load_entry() -> Result<ash::Entry, VulkanError> {
    // SAFETY: loading runs the initialisers of the system's Vulkan loader and nothing else; the
    // library stays loaded as long as a clone of the entry lives, and every user holds one.
    unsafe { ash::Entry::load() }.map_err(|e| VulkanError::NoLoader { reason: e.to_string() })
}

/// The loader's version as (major, minor, patch) text; a 1.0 loader has no such query.
pub(crate) fn loader_version(entry: &ash::Entry) -> Result<u32, VulkanError> {
    // SAFETY: a global query with no preconditions.
    let version = unsafe { entry.try_enumerate_instance_version() }.during("asking the loader's version")?;
    Ok(version.unwrap_or(vk::API_VERSION_1_0))
}

/// Every layer the loader knows.
pub(crate) fn layers(entry: &ash::Entry) -> Result<Vec<vk::LayerProperties>, VulkanError> {
    // SAFETY: a global query with no preconditions.
    unsafe { entry.enumerate_instance_layer_properties() }.during("listing the layers")
}

fn extensions(entry: &ash::Entry, layer: Option<&CStr>) -> Result<Vec<CString>, VulkanError> {
    // SAFETY: a global query; the layer, when given, was found in the loader's own list.
    let found = unsafe { entry.enumerate_instance_extension_properties(layer) }
        .during("listing the instance extensions")?;
    Ok(found.iter().filter_map(|e| e.extension_name_as_c_str().ok().map(CStr::to_owned)).collect())
}

/// `1.3.239` for a packed Vulkan version.
pub(crate) fn version_text(version: u32) -> String {
    format!(
        "{}.{}.{}",
        vk::api_version_major(version),
        vk::api_version_minor(version),
        vk::api_version_patch(version)
    )
}

/// What the instance is created with, decided before the call.
struct Plan {
    extensions: Vec<CString>,
    validated: bool,
    sync: bool,
    debug_utils: bool,
}

fn plan(entry: &ash::Entry, validation: Validation, asked: &[CString]) -> Result<Plan, VulkanError> {
    let mut available = extensions(entry, None)?;
    let mut wanted = asked.to_vec();
    let (mut validated, mut with_sync) = (false, false);
    if let Validation::On { required, sync } = validation {
        let present = layers(entry)?.iter().any(|l| l.layer_name_as_c_str() == Ok(VALIDATION_LAYER));
        if present {
            validated = true;
            let of_layer = extensions(entry, Some(VALIDATION_LAYER))?;
            with_sync = sync && of_layer.iter().any(|e| e.as_c_str() == ash::ext::validation_features::NAME);
            if with_sync {
                wanted.push(ash::ext::validation_features::NAME.to_owned());
            } else if sync && required {
                let what = "VK_EXT_validation_features (synchronization validation)".to_string();
                return Err(VulkanError::MissingFeature {
                    device: "VK_LAYER_KHRONOS_validation".into(),
                    what,
                });
            }
            available.extend(of_layer);
        } else if required {
            return Err(VulkanError::ValidationLayerMissing);
        } else {
            tracing::warn!("{}", VulkanError::ValidationLayerMissing);
        }
    }
    let debug_utils = available.iter().any(|e| e.as_c_str() == ash::ext::debug_utils::NAME);
    if debug_utils {
        wanted.push(ash::ext::debug_utils::NAME.to_owned());
    } else if validated {
        // Without a messenger an error could not stop the run.
        let what = "VK_EXT_debug_utils (validation messages)".to_string();
        return Err(VulkanError::MissingFeature { device: "the Vulkan loader".into(), what });
    }
    for name in asked {
        if !available.contains(name) {
            let what = format!("the instance extension {}", name.to_string_lossy());
            return Err(VulkanError::MissingFeature { device: "the Vulkan loader".into(), what });
        }
    }
    Ok(Plan { extensions: wanted, validated, sync: with_sync, debug_utils })
}

fn messenger_info(messages: &Arc<Messages>) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    use vk::{DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type};
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::ERROR | Severity::WARNING)
        .message_type(Type::GENERAL | Type::VALIDATION | Type::PERFORMANCE)
        .pfn_user_callback(Some(on_message))
        .user_data(Arc::as_ptr(messages).cast_mut().cast::<c_void>())
}

impl Instance {
    /// Creates a Vulkan 1.3 instance with the extensions asked for (a window's surface, say).
    pub(crate) fn new(validation: Validation, asked: &[CString]) -> Result<Self, VulkanError> {
        let entry = load_entry()?;
        let version = loader_version(&entry)?;
        if version < vk::API_VERSION_1_3 {
            let reason = format!("the loader is {}, 1.3 is needed", version_text(version));
            return Err(VulkanError::NoLoader { reason });
        }
        let plan = plan(&entry, validation, asked)?;
        let messages = Arc::new(Messages::default());
        let raw = create_raw(&entry, &plan, &messages)?;
        let mut instance = Self {
            raw,
            debug_utils: plan.debug_utils,
            validated: plan.validated,
            messages,
            messenger: None,
            entry,
        };
        if plan.debug_utils {
            let loader = ash::ext::debug_utils::Instance::new(&instance.entry, &instance.raw);
            let info = messenger_info(&instance.messages);
            // SAFETY: the extension is enabled; the user data points into `messages`, which
            // `Instance` keeps until after the messenger is destroyed.
            let messenger = unsafe { loader.create_debug_utils_messenger(&info, None) }
                .during("creating the debug messenger")?;
            instance.messenger = Some((loader, messenger));
        }
        Ok(instance)
    }
}

fn create_raw(
    entry: &ash::Entry,
    plan: &Plan,
    messages: &Arc<Messages>,
) -> Result<ash::Instance, VulkanError> {
    let app = vk::ApplicationInfo::default()
        .application_name(c"worsted")
        .engine_name(c"worsted")
        .api_version(vk::API_VERSION_1_3);
    let names: Vec<_> = plan.extensions.iter().map(|e| e.as_ptr()).collect();
    let layer_names = if plan.validated { vec![VALIDATION_LAYER.as_ptr()] } else { vec![] };
    let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
    // A messenger chained here hears the creation and the destruction of the instance itself.
    let mut early = messenger_info(messages);
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&app)
        .enabled_extension_names(&names)
        .enabled_layer_names(&layer_names);
    if plan.sync {
        info = info.push_next(&mut features);
    }
    if plan.debug_utils {
        info = info.push_next(&mut early);
    }
    // SAFETY: every pointer in `info` refers to locals that outlive the call, the names were found
    // in the loader's lists, and the messages outlive the instance (see `Instance`).
    unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
        vk::Result::ERROR_INCOMPATIBLE_DRIVER | vk::Result::ERROR_INITIALIZATION_FAILED => {
            VulkanError::NoDriver { reason: format!("creating the instance: {result:?}") }
        }
        result => VulkanError::from_vk("creating the instance", result),
    })
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: `Instance` is dropped after everything made from it (it is the last field of
        // `Device`), and `messages` still lives: fields drop after this body.
        unsafe {
            if let Some((loader, messenger)) = self.messenger.take() {
                loader.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

/// Receives every message of severity warning and above.
///
/// Errors of the validation layer are kept, to stop the run at the next check. Errors of type
/// GENERAL come from the loader (a broken driver among several, say) and only warn: whether a
/// usable device is left is decided by device selection.
unsafe extern "system" fn on_message(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    types: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    if data.is_null() || user.is_null() {
        return vk::FALSE;
    }
    // SAFETY: the loader passes valid callback data for the duration of the call, and `user` is the
    // `Messages` that `messenger_info` registered, alive as long as its instance.
    let (data, messages) = unsafe { (&*data, &*user.cast_const().cast::<Messages>()) };
    // SAFETY: by specification these are null or zero-terminated strings.
    let (id, text) = unsafe { (text_at(data.p_message_id_name), text_at(data.p_message)) };
    let text = format!("{id}: {}", one_line(&text));
    let from_layer = types.intersects(
        vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
    );
    if severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR) && from_layer {
        tracing::error!("Vulkan validation: {text}");
        messages.record(text);
    } else {
        tracing::warn!("Vulkan: {text}");
    }
    vk::FALSE
}

/// # Safety
/// `text` is null or points to a zero-terminated string that lives for the call.
unsafe fn text_at(text: *const std::ffi::c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: not null, and zero-terminated by this function's contract.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_kept_once_and_the_excess_is_counted() {
        let messages = Messages::default();
        messages.check().expect("nothing was recorded");
        for i in 0..KEPT_ERRORS + 4 {
            messages.record(format!("error {i}"));
        }
        let text = messages.check().unwrap_err().to_string();
        assert!(text.contains("error 0 | error 1 |") && text.ends_with("| and 4 more"), "{text}");
        messages.check().expect("reported already");
    }
}
