//! An X server, the program in it, and a hand on its keyboard and pointer.

use crate::desktop::{ask_to_close, drop_file};
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};
use worsted::io::picture::DisplayImage;

/// Longest that anything may take on the slowest machine.
const PATIENCE: Duration = Duration::from_secs(240);
/// Time that the window gets to show what the program has drawn.
const SETTLING: Duration = Duration::from_millis(700);
/// Size of the server's screen.
const SCREEN: &str = "1280x960x24";

/// What the log said of pictures since the last time.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    /// Nothing better follows.
    pub settled: bool,
    /// The last one's size in pixels.
    pub size: [u32; 2],
    /// The last one's wish.
    pub revision: u64,
    /// Pictures that were drawn smaller than wanted, while something moved.
    pub small: u32,
}

/// A program in a window of its own server. Both end with it.
pub struct Session {
    server: Child,
    display: String,
    program: Child,
    window: String,
    log: Receiver<String>,
    heard: Vec<String>,
    /// Lines that were asked for are before this one.
    asked: usize,
    /// What is edited.
    pub scene: PathBuf,
    _home: tempfile::TempDir,
}

impl Drop for Session {
    fn drop(&mut self) {
        // Whoever ended already cannot be killed.
        drop(self.program.kill());
        drop(self.program.wait());
        drop(self.server.kill());
        drop(self.server.wait());
    }
}

impl Session {
    /// Opens a copy of the demo in a window of this size.
    pub fn open(size: [u32; 2], options: &[&str]) -> Self {
        Self::open_what(size, options, &[], |home| {
            for file in ["demo.toml", "stockinette.bcc"] {
                std::fs::copy(format!("models/{file}"), home.join(file)).unwrap();
            }
            home.join("demo.toml")
        })
    }

    /// Opens what `make` puts into a folder, in an environment with these variables besides.
    pub fn open_what(
        size: [u32; 2],
        options: &[&str],
        variables: &[(&str, &str)],
        make: impl FnOnce(&Path) -> PathBuf,
    ) -> Self {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", SCREEN, "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb, of the Debian package xvfb");
        let mut number = String::new();
        BufReader::new(server.stdout.as_mut().unwrap()).read_line(&mut number).unwrap();
        let display = format!(":{}", number.trim());
        let home = tempfile::tempdir().unwrap();
        let scene = make(home.path());
        let mut program = Command::new(env!("CARGO_BIN_EXE_worsted"))
            .arg("view")
            .arg(&scene)
            .args(["-v", "--validate", "--device", "software"])
            .args(["--size", &format!("{}x{}", size[0], size[1])])
            .arg("--cache")
            .arg(home.path().join("cache"))
            .args(options)
            .env("DISPLAY", &display)
            .env("XDG_CONFIG_HOME", home.path())
            .env_remove("WAYLAND_DISPLAY")
            .envs(variables.iter().copied())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (tell, log) = channel();
        let stderr = program.stderr.take().unwrap();
        std::thread::spawn(move || {
            for line in BufReader::new(stderr).lines().map_while(Result::ok) {
                if tell.send(line).is_err() {
                    break;
                }
            }
        });
        let mut session = Self {
            server,
            display,
            program,
            window: String::new(),
            log,
            heard: Vec::new(),
            asked: 0,
            scene,
            _home: home,
        };
        session.window = session.found_window();
        session
    }

    fn tool(&self, name: &str, arguments: &[&str]) -> Vec<u8> {
        let mut command = Command::new(name);
        let output = command.args(arguments).env("DISPLAY", &self.display).output();
        let output = output.unwrap_or_else(|e| panic!("{name}, of the Debian packages for windows: {e}"));
        assert!(output.status.success(), "{name} {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    }

    fn found_window(&self) -> String {
        let started = Instant::now();
        loop {
            let found = Command::new("xdotool")
                .args(["search", "--name", "^Worsted"])
                .env("DISPLAY", &self.display)
                .output()
                .expect("xdotool, of the Debian package of that name");
            if let Some(window) = String::from_utf8_lossy(&found.stdout).lines().next() {
                return window.to_owned();
            }
            assert!(started.elapsed() < PATIENCE, "no window opened");
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Waits until nothing better follows than what is drawn.
    pub fn until_settled(&mut self) -> Drawn {
        let mut drawn = Drawn::default();
        let started = Instant::now();
        // What was wanted before may settle first: it is over where nothing more comes.
        loop {
            let wait = if drawn.settled { SETTLING } else { PATIENCE.saturating_sub(started.elapsed()) };
            match self.log.recv_timeout(wait) {
                Ok(line) => {
                    if let Some(of) = line.split_once("picture ").map(|(_, of)| of) {
                        drawn.note(of);
                    }
                    self.heard.push(line);
                }
                Err(RecvTimeoutError::Timeout) if drawn.settled => return drawn,
                Err(_) => panic!("no picture settled; the log: {:#?}", self.heard),
            }
        }
    }

    /// Waits for a line of the log that has this, behind the one that was waited for last.
    pub fn until_said(&mut self, what: &str) -> String {
        let started = Instant::now();
        loop {
            while let Some(line) = self.heard.get(self.asked) {
                self.asked += 1;
                if line.contains(what) {
                    return line.clone();
                }
            }
            match self.log.recv_timeout(PATIENCE.saturating_sub(started.elapsed())) {
                Ok(line) => self.heard.push(line),
                Err(_) => panic!("expected {what:?}; the log: {:#?}", self.heard),
            }
        }
    }

    /// What is drawn in the next three seconds.
    pub fn for_a_while(&mut self) -> Drawn {
        let (mut drawn, until) = (Drawn::default(), Instant::now() + Duration::from_secs(3));
        while let Ok(line) = self.log.recv_timeout(until.saturating_duration_since(Instant::now())) {
            if let Some(of) = line.split_once("picture ").map(|(_, of)| of) {
                drawn.note(of);
            }
            self.heard.push(line);
        }
        drawn
    }

    /// Waits until what was said to the user is gone.
    pub fn wait_for_words(&self) {
        std::thread::sleep(Duration::from_secs(9));
    }

    /// Lets the window show what was done to its panel.
    pub fn settle_ui(&self) {
        std::thread::sleep(SETTLING);
    }

    pub fn click(&self, [x, y]: [u32; 2]) {
        self.focus();
        let at = ["mousemove", "--window", &self.window, &x.to_string(), &y.to_string()];
        self.tool("xdotool", &at);
        self.pause();
        self.tool("xdotool", &["mousedown", "1"]);
        self.pause();
        self.tool("xdotool", &["mouseup", "1"]);
        self.pause();
    }

    pub fn drag(&self, from: [u32; 2], to: [u32; 2]) {
        self.focus();
        let step = |share: f64| {
            let at: Vec<String> = (0..2)
                .map(|i| {
                    (f64::from(from[i]) + share * (f64::from(to[i]) - f64::from(from[i]))).round().to_string()
                })
                .collect();
            self.tool("xdotool", &["mousemove", "--window", &self.window, &at[0], &at[1]]);
            self.pause();
        };
        step(0.0);
        self.tool("xdotool", &["mousedown", "1"]);
        (1..=8).for_each(|k| step(f64::from(k) / 8.0));
        self.tool("xdotool", &["mouseup", "1"]);
    }

    pub fn press(&self, key: &str) {
        self.tool("xdotool", &["key", key]);
        self.pause();
    }

    pub fn type_text(&self, text: &str) {
        self.tool("xdotool", &["type", "--delay", "40", text]);
        self.pause();
    }

    pub fn resize(&self, [width, height]: [u32; 2]) {
        self.tool("xdotool", &["windowsize", &self.window, &width.to_string(), &height.to_string()]);
    }

    /// Takes the window off the screen, as an icon is made of it, and puts it back.
    pub fn hide_and_show(&self) {
        self.tool("xdotool", &["windowunmap", "--sync", &self.window]);
        self.pause();
        self.tool("xdotool", &["windowmap", "--sync", &self.window]);
        self.pause();
    }

    /// Drops a file on the window.
    pub fn drop_file(&self, path: &Path) {
        let window = self.window.parse().unwrap();
        drop_file(&self.display, window, path).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    }

    /// Closes the window as the system's button does, and holds the program to a good end.
    pub fn close_by_button(mut self) {
        ask_to_close(&self.display, self.window.parse().unwrap()).unwrap();
        self.ends();
    }

    fn focus(&self) {
        self.tool("xdotool", &["windowfocus", &self.window]);
    }

    fn pause(&self) {
        std::thread::sleep(Duration::from_millis(120));
    }

    /// What the window shows.
    pub fn shot(&self) -> Shot {
        std::thread::sleep(SETTLING);
        let bytes = self.tool("import", &["-window", &self.window, "png:-"]);
        let image = image::load_from_memory(&bytes).expect("a picture of the window").to_rgb8();
        Shot { width: image.width(), height: image.height(), pixels: image.pixels().map(|p| p.0).collect() }
    }

    /// Closes the window as its user does, and holds the program to a good end.
    pub fn close(mut self) {
        self.focus();
        self.press("ctrl+q");
        self.ends();
    }

    /// Waits for the program's end: a good one, without a word of what validation found or was left behind.
    pub fn ends(&mut self) {
        let started = Instant::now();
        let status = loop {
            if let Some(status) = self.program.try_wait().unwrap() {
                break status;
            }
            assert!(started.elapsed() < PATIENCE, "the program does not end");
            std::thread::sleep(Duration::from_millis(100));
        };
        while let Ok(line) = self.log.recv_timeout(SETTLING) {
            self.heard.push(line);
        }
        let mut rest = String::new();
        if let Some(out) = &mut self.program.stdout {
            out.read_to_string(&mut rest).unwrap();
        }
        assert!(status.success(), "{status}: {:#?}", self.heard);
        let bad = self.heard.iter().find(|line| line.contains("ERROR") || line.contains("alidation"));
        assert_eq!(bad, None, "{:#?}", self.heard);
    }
}

impl Drawn {
    /// `7: 400x300 of 800x600, 4 samples, settled`
    fn note(&mut self, of: &str) {
        let Some((revision, rest)) = of.split_once(": ") else { return };
        let sizes: Vec<[u32; 2]> = rest
            .split([' ', ','])
            .filter_map(|word| {
                let (width, height) = word.split_once('x')?;
                Some([width.parse().ok()?, height.parse().ok()?])
            })
            .collect();
        let [size, whole] = sizes[..] else { return };
        self.revision = revision.parse().unwrap_or(self.revision);
        self.size = size;
        self.small += u32::from(size != whole);
        self.settled = rest.ends_with(", settled");
    }
}

/// What a window shows.
#[derive(Clone)]
pub struct Shot {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 3]>,
}

impl Shot {
    /// One color everywhere.
    pub fn filled([width, height]: [u32; 2], color: [u8; 3]) -> Self {
        Self { width, height, pixels: vec![color; (width * height) as usize] }
    }

    /// Paints a square around a place.
    pub fn paint(&mut self, at: [u32; 2], reach: u32, color: [u8; 3]) {
        for place in self.around(at, reach) {
            self.pixels[place] = color;
        }
    }

    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// What it shows of this size from `left` on, down to the lower edge.
    pub fn cut(&self, left: u32, [width, height]: [u32; 2]) -> DisplayImage {
        let top = self.height - height;
        let row = |y: u32| (left..left + width).map(move |x| (y, x));
        let places = (top..self.height).flat_map(row);
        let pixels = places.map(|(y, x)| {
            let [r, g, b] = self.pixels[(y * self.width + x) as usize];
            [r, g, b, 255]
        });
        DisplayImage { width, height, pixels: pixels.collect() }
    }

    fn around(&self, [x, y]: [u32; 2], reach: u32) -> Vec<usize> {
        let columns = x.saturating_sub(reach)..(x + reach).min(self.width);
        let rows = y.saturating_sub(reach)..(y + reach).min(self.height);
        rows.flat_map(|row| columns.clone().map(move |column| (row, column)))
            .map(|(row, column)| (row * self.width + column) as usize)
            .collect()
    }

    /// Share of the pixels around a place that differ.
    pub fn differing(&self, other: &Self, at: [u32; 2], reach: u32) -> f64 {
        assert_eq!(self.size(), other.size());
        let places = self.around(at, reach);
        let differing = places.iter().filter(|&&place| self.pixels[place] != other.pixels[place]);
        differing.count() as f64 / places.len() as f64
    }

    /// Whether there is more around a place than one color, or a few.
    pub fn is_varied(&self, at: [u32; 2], reach: u32) -> bool {
        let mut colors: Vec<[u8; 3]> =
            self.around(at, reach).iter().map(|&place| self.pixels[place]).collect();
        colors.sort_unstable();
        colors.dedup();
        colors.len() > 1
    }
}
