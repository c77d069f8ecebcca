//! Queries from a reader to answers in a writer, batch by batch, so that memory stays bounded.

use super::fields::Values;
use super::function::Function;
use super::kernel::{Answer, Kernel};
use super::line::{answer, error, parse};
use crate::error::Error;
use rayon::prelude::*;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};

/// Most lines evaluated at once.
const BATCH: usize = 8192;
/// Longest line in bytes; no query needs a tenth of it.
const LONGEST: u64 = 1 << 16;
/// Bytes read ahead.
const READ_AHEAD: usize = 1 << 20;

/// What a run came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Lines read, and as many written.
    pub lines: u64,
    /// Those answered with an error.
    pub errors: u64,
}

/// Answers every line of `queries`, in order: on the device with its `kernel`, in f64 without one. Lines that have
/// arrived are answered before more are waited for. A line that cannot be answered gets an object
/// `{"error": "line N: ..."}`.
///
/// # Errors
/// Reading, writing, and the device.
pub fn probe(
    function: &'static Function,
    mut kernel: Option<Kernel>,
    queries: impl Read,
    mut answers: impl Write,
) -> Result<Tally, Error> {
    let mut reader = BufReader::with_capacity(READ_AHEAD, queries);
    let mut tally = Tally::default();
    loop {
        let lines =
            read_batch(&mut reader).map_err(|e| Error::Arguments(format!("cannot read queries: {e}")))?;
        if lines.is_empty() {
            return Ok(tally);
        }
        let values: Vec<Result<Vec<f64>, String>> =
            lines.into_par_iter().map(|line| line.and_then(|text| parse(function, &text))).collect();
        let found = evaluate(function, kernel.as_mut(), &values)?;
        let mut found = found.into_iter();
        let mut text = Vec::new();
        for query in &values {
            tally.lines += 1;
            let answered = query
                .as_ref()
                .map_err(String::clone)
                .and_then(|query| answer(function, query, &found.next().unwrap_or_else(|| Ok(Vec::new()))?));
            let line = answered.unwrap_or_else(|message| {
                tally.errors += 1;
                error(tally.lines, &message)
            });
            push_line(&mut text, &line);
        }
        let written = answers.write_all(&text).and_then(|()| answers.flush());
        written.map_err(|e| Error::Arguments(format!("cannot write answers: {e}")))?;
    }
}

/// The function's numbers for the queries that are good.
fn evaluate(
    function: &'static Function,
    kernel: Option<&mut Kernel>,
    values: &[Result<Vec<f64>, String>],
) -> Result<Vec<Answer>, Error> {
    let good: Vec<&[f64]> = values.iter().flatten().map(Vec::as_slice).collect();
    Ok(match kernel {
        Some(kernel) => kernel.answers(&good)?,
        None => good.par_iter().map(|query| Ok((function.exact)(Values::new(query)))).collect(),
    })
}

fn push_line(text: &mut Vec<u8>, line: &Value) {
    text.extend(line.to_string().bytes());
    text.push(b'\n');
}

/// A line, or what is wrong with it before it is looked into.
type Line = Result<String, String>;

/// Waits for a line, then takes those that have arrived with it; none at the end.
fn read_batch<R: Read>(reader: &mut BufReader<R>) -> std::io::Result<Vec<Line>> {
    let mut lines = Vec::new();
    while lines.len() < BATCH && (lines.is_empty() || !reader.buffer().is_empty()) {
        match read_line(reader)? {
            Some(line) => lines.push(line),
            None => break,
        }
    }
    Ok(lines)
}

fn read_line(reader: &mut impl BufRead) -> std::io::Result<Option<Line>> {
    let mut bytes = Vec::new();
    if reader.by_ref().take(LONGEST).read_until(b'\n', &mut bytes)? == 0 {
        return Ok(None);
    }
    if bytes.last() != Some(&b'\n') && bytes.len() as u64 == LONGEST {
        reader.skip_until(b'\n')?;
        return Ok(Some(Err(format!("expected at most {LONGEST} bytes"))));
    }
    Ok(Some(String::from_utf8(bytes).map_err(|_| "not UTF-8".into())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::find;
    use serde_json::json;

    fn run(function: &str, queries: &[u8]) -> (Vec<Value>, Tally) {
        let mut answers = Vec::new();
        let tally = probe(find(function).unwrap(), None, queries, &mut answers).unwrap();
        let lines = String::from_utf8(answers).unwrap();
        assert!(lines.is_empty() || lines.ends_with('\n'));
        (lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect(), tally)
    }

    #[test]
    fn every_line_is_answered_in_order_and_faults_name_their_line() {
        let text = "{\"width_lod\": 1, \"width_fiber\": 2, \"width_ply\": 9}\n\nnot JSON\n[1]\n{\"width_lod\": 1}\n\
                    {\"width_lod\": -1, \"width_fiber\": 2, \"width_ply\": 9}\n\
                    {\"width_lod\": 1, \"width_fiber\": \"2\", \"width_ply\": 9}\n\
                    {\"width_lod\": 4, \"width_fiber\": 1, \"width_ply\": 3.5}";
        let (answers, tally) = run("lod_factor", text.as_bytes());
        assert_eq!(tally, Tally { lines: 8, errors: 6 });
        assert_eq!((&answers[0], &answers[7]), (&json!({"factor": 1.0}), &json!({"factor": 0.0})));
        let says = [
            "line 2: not JSON",
            "line 3: not JSON",
            "line 4: expected an object",
            "line 5: width_fiber: missing, expected a number from 0 to 1000000",
            "line 6: width_lod = -1: expected a number from 0 to 1000000",
            "line 7: width_fiber = \"2\": expected a number",
        ];
        for (answer, expected) in answers[1..7].iter().zip(says) {
            let message = answer["error"].as_str().unwrap();
            assert!(message.starts_with(expected) && !message.contains('\n'), "{message}");
        }
    }

    #[test]
    fn endless_lines_and_bytes_that_are_no_text_take_one_line_each() {
        let mut text = vec![b'x'; 3 << 16];
        text.extend(b"\n\xff\xfe\n{}\n");
        let (answers, tally) = run("lod_factor", &text);
        assert_eq!(tally, Tally { lines: 3, errors: 3 });
        for (answer, expected) in
            answers.iter().zip(["at most 65536 bytes", "not UTF-8", "width_lod: missing"])
        {
            assert!(answer["error"].as_str().unwrap().contains(expected), "{answer}");
        }
        assert_eq!(run("lod_factor", b"").1, Tally::default());
    }

    #[test]
    fn more_lines_than_a_batch_stay_in_order() {
        let count = 3 * BATCH + 17;
        let line = |i: usize| {
            format!("{{\"phi\": {}, \"theta_h\": 0, \"width\": 0.1, \"strength\": 1}}\n", 1e-4 * i as f64)
        };
        let text: String = (0..count).map(line).collect();
        let (answers, tally) = run("simple_specular", text.as_bytes());
        assert_eq!(tally, Tally { lines: count as u64, errors: 0 });
        for (i, answer) in answers.iter().enumerate() {
            let expected = (0.5 * f64::from((1e-4 * i as f64) as f32)).cos().abs();
            assert!((answer["value"].as_f64().unwrap() - expected).abs() < 1e-12, "{i}: {answer}");
        }
    }
}
