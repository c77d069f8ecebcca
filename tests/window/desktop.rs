//! Other programs of a desktop: one from which a file is dragged on the window (XDND, version 5), and the one whose button
//! closes it.

use std::path::Path;
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::errors::ReplyOrIdError;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    Atom, AtomEnum, ClientMessageEvent, ConnectionExt, CreateWindowAux, EventMask, PropMode,
    SELECTION_NOTIFY_EVENT, SelectionNotifyEvent, SelectionRequestEvent, Window, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;
use x11rb::{COPY_DEPTH_FROM_PARENT, CURRENT_TIME, connect};

/// Longest that the window may take to answer.
const PATIENCE: Duration = Duration::from_secs(60);
const VERSION: u32 = 5;
/// Where the file is let go, in pixels of the screen.
const PLACE: u32 = (300 << 16) | 300;

struct Source {
    connection: RustConnection,
    own: Window,
    target: Window,
    text: String,
}

/// Drags a file over a window and lets it go, as a file manager does.
pub fn drop_file(display: &str, target: Window, path: &Path) -> Result<(), String> {
    let dropped = Source::new(display, target, path).map_err(|e| e.to_string())?.drag();
    dropped.map_err(|e| e.to_string())?.then_some(()).ok_or_else(|| "the window does not answer".into())
}

/// Asks a window to close, as the button of its frame does.
pub fn ask_to_close(display: &str, target: Window) -> Result<(), String> {
    let ask = || -> Result<(), Box<dyn std::error::Error>> {
        let (connection, _) = connect(Some(display))?;
        let atom = |name: &str| -> Result<Atom, ReplyOrIdError> {
            Ok(connection.intern_atom(false, name.as_bytes())?.reply()?.atom)
        };
        let data = [atom("WM_DELETE_WINDOW")?, CURRENT_TIME, 0, 0, 0];
        let message = ClientMessageEvent::new(32, target, atom("WM_PROTOCOLS")?, data);
        connection.send_event(false, target, EventMask::NO_EVENT, message)?;
        // Answered after what was sent before.
        connection.get_input_focus()?.reply()?;
        Ok(())
    };
    ask().map_err(|e| e.to_string())
}

impl Source {
    fn new(display: &str, target: Window, path: &Path) -> Result<Self, Box<dyn std::error::Error>> {
        let (connection, screen) = connect(Some(display))?;
        let root = connection.setup().roots[screen].root;
        let own = connection.generate_id()?;
        let class = WindowClass::INPUT_OUTPUT;
        let looks = CreateWindowAux::new();
        connection.create_window(COPY_DEPTH_FROM_PARENT, own, root, 0, 0, 1, 1, 0, class, 0, &looks)?;
        let text = format!("file://{}\r\n", path.display());
        Ok(Self { connection, own, target, text })
    }

    fn atom(&self, name: &str) -> Result<Atom, ReplyOrIdError> {
        Ok(self.connection.intern_atom(false, name.as_bytes())?.reply()?.atom)
    }

    fn send(&self, name: &str, data: [u32; 5]) -> Result<(), ReplyOrIdError> {
        let message = ClientMessageEvent::new(32, self.target, self.atom(name)?, data);
        self.connection.send_event(false, self.target, EventMask::NO_EVENT, message)?;
        Ok(self.connection.flush()?)
    }

    /// Whether the window took it.
    fn drag(&self) -> Result<bool, ReplyOrIdError> {
        let kind = self.atom("text/uri-list")?;
        self.connection.set_selection_owner(self.own, self.atom("XdndSelection")?, CURRENT_TIME)?;
        self.send("XdndEnter", [self.own, VERSION << 24, kind, 0, 0])?;
        self.send("XdndPosition", [self.own, 0, PLACE, CURRENT_TIME, self.atom("XdndActionCopy")?])?;
        let (status, finished) = (self.atom("XdndStatus")?, self.atom("XdndFinished")?);
        let (started, mut let_go) = (Instant::now(), false);
        while started.elapsed() < PATIENCE {
            match self.connection.poll_for_event()? {
                Some(Event::SelectionRequest(request)) => self.answer(&request)?,
                Some(Event::ClientMessage(message)) if message.type_ == status && !let_go => {
                    if message.data.as_data32()[1] & 1 == 0 {
                        return Ok(false);
                    }
                    self.send("XdndDrop", [self.own, 0, CURRENT_TIME, 0, 0])?;
                    let_go = true;
                }
                Some(Event::ClientMessage(message)) if message.type_ == finished => return Ok(true),
                Some(_) => (),
                None => std::thread::sleep(Duration::from_millis(10)),
            }
        }
        Ok(false)
    }

    /// Hands over the file's address.
    fn answer(&self, request: &SelectionRequestEvent) -> Result<(), ReplyOrIdError> {
        let (to, property) = (request.requestor, request.property);
        self.connection.change_property8(
            PropMode::REPLACE,
            to,
            property,
            request.target,
            self.text.as_bytes(),
        )?;
        let notice = SelectionNotifyEvent {
            response_type: SELECTION_NOTIFY_EVENT,
            sequence: 0,
            time: request.time,
            requestor: to,
            selection: request.selection,
            target: request.target,
            property: if property == u32::from(AtomEnum::NONE) { request.target } else { property },
        };
        self.connection.send_event(false, to, EventMask::NO_EVENT, notice)?;
        Ok(self.connection.flush()?)
    }
}
