//! A server that is slow, busy, silent, cuts its answers short or lies: what it delays is read whole, and what it withholds is an error.

#![allow(clippy::unwrap_used)] // what tests share has no attribute by which the lints know it

use hovertone_media::{FileAccess, OpenOptions, Recording};
use hovertone_signal::SignalSource;
use hovertone_stores::{Address, Patience, StoredFile, Stores};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::net::{TcpListener, TcpStream};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

/// Several blocks, the last one not whole.
const SIZE: usize = (3 << 20) + 12_345;
/// The tests wait for milliseconds where a user waits for seconds.
const PATIENCE: Patience = Patience { retries_max: 3, pause_s: 0.01, silence_s_max: 0.5, answer_s_max: 10.0 };

/// How a part of the file is answered.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Answer {
    Good,
    /// This status in place of the part.
    Status(u16),
    /// Half of the part, then the connection ends.
    Cut,
    /// In pieces with pauses.
    Slow,
    /// Half of the part, then nothing.
    Silent,
    /// The whole file, as servers without ranges do.
    WholeFile,
    /// Fewer bytes than were asked for, with a header that says so.
    OtherRange,
}

/// The answer to a request, from its number, counted from 0, and its range.
type Answering = fn(usize, &Range<usize>) -> Answer;
/// The tag in the answer to a request.
type Tagging = fn(usize) -> Option<usize>;

/// What a server does.
#[derive(Clone, Copy)]
struct Manner {
    answer: Answering,
    tag: Tagging,
}

const TAGGED: Tagging = |_| Some(1);
const UNTAGGED: Tagging = |_| None;

/// A recording: a second of noise is enough for the decoder, and its blocks are all different.
fn bytes() -> Vec<u8> {
    let data = SIZE - 44;
    let mut bytes = Vec::with_capacity(SIZE);
    bytes.extend(b"RIFF");
    bytes.extend((data as u32 + 36).to_le_bytes());
    bytes.extend(b"WAVEfmt ");
    bytes.extend(16u32.to_le_bytes());
    bytes.extend([1, 0, 1, 0]);
    bytes.extend(48_000u32.to_le_bytes());
    bytes.extend(96_000u32.to_le_bytes());
    bytes.extend([2, 0, 16, 0]);
    bytes.extend(b"data");
    bytes.extend((data as u32).to_le_bytes());
    let mut state = 1u32;
    bytes.extend((0..data).map(|_| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    }));
    bytes
}

/// Starts a server, which ends with the test program; returns the file in it, and the number of requests for parts so far.
fn served(manner: Manner) -> (StoredFile, Arc<AtomicUsize>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let text = format!("http://{}/flights/hover.wav", listener.local_addr().unwrap());
    let (bytes, count) = (Arc::new(bytes()), Arc::new(AtomicUsize::new(0)));
    let counted = Arc::clone(&count);
    thread::spawn(move || {
        for stream in listener.incoming().filter_map(Result::ok) {
            let (bytes, count) = (Arc::clone(&bytes), Arc::clone(&counted));
            thread::spawn(move || {
                // an end of the connection is what the other side may do
                let _ = answer(stream, &bytes, manner, &count);
            });
        }
    });
    let file = Stores::new(PATIENCE).unwrap().file(&Address::parse(&text).unwrap()).unwrap();
    (file, count)
}

fn answer(mut stream: TcpStream, bytes: &[u8], manner: Manner, count: &AtomicUsize) -> io::Result<()> {
    let mut range = None;
    let mut is_head = false;
    for (number, line) in BufReader::new(stream.try_clone()?).lines().enumerate() {
        let line = line?.to_lowercase();
        is_head |= number == 0 && line.starts_with("head");
        if let Some((from, to)) = line.strip_prefix("range: bytes=").and_then(|range| range.split_once('-')) {
            range = from.parse::<usize>().ok().zip(to.parse::<usize>().ok()).map(|(from, to)| from..to + 1);
        }
        if line.is_empty() {
            break;
        }
    }
    let whole = 0..bytes.len();
    let Some(range) = range.filter(|_| !is_head) else {
        let tag = tag_line((manner.tag)(0));
        return write!(stream, "HTTP/1.1 200 OK\r\nContent-Length: {}\r\n{tag}Connection: close\r\n\r\n", whole.end);
    };
    let number = count.fetch_add(1, Ordering::Relaxed);
    let answer = (manner.answer)(number, &range);
    if let Answer::Status(status) = answer {
        return write!(stream, "HTTP/1.1 {status} Trouble\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    }
    let sent = match answer {
        Answer::WholeFile => whole.clone(),
        Answer::OtherRange => range.start..range.end - 1,
        _ => range.clone(),
    };
    let status = if answer == Answer::WholeFile { "200 OK" } else { "206 Partial Content" };
    let tag = tag_line((manner.tag)(number));
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Length: {}\r\nContent-Range: bytes {}-{}/{}\r\n{tag}Connection: close\r\n\r\n",
        sent.len(),
        sent.start,
        sent.end - 1,
        whole.end
    )?;
    let body = &bytes[sent];
    match answer {
        Answer::Cut => stream.write_all(&body[..body.len() / 2]),
        Answer::Silent => {
            stream.write_all(&body[..body.len() / 2])?;
            thread::sleep(Duration::from_secs(5));
            Ok(())
        }
        Answer::Slow => body.chunks(body.len().div_ceil(5)).try_for_each(|piece| {
            thread::sleep(Duration::from_millis(200));
            stream.write_all(piece)
        }),
        _ => stream.write_all(body),
    }
}

fn tag_line(tag: Option<usize>) -> String {
    tag.map_or(String::new(), |tag| format!("ETag: \"{tag}\"\r\n"))
}

fn read_whole(file: &StoredFile) -> io::Result<Vec<u8>> {
    let mut read = Vec::new();
    file.open()?.read_to_end(&mut read).map(|_| read)
}

#[test]
fn what_a_server_delays_or_repeats_is_read_whole() {
    let manners: [(&str, Answering); 6] = [
        ("good", |_, _| Answer::Good),
        ("busy", |number, _| if number % 3 == 2 { Answer::Good } else { Answer::Status(503) }),
        ("broken", |number, _| if number % 2 == 1 { Answer::Good } else { Answer::Status(500) }),
        ("cut", |number, _| if number % 2 == 1 { Answer::Good } else { Answer::Cut }),
        ("slow", |_, _| Answer::Slow),
        ("silent", |number, _| if number == 0 { Answer::Silent } else { Answer::Good }),
    ];
    for (name, answer) in manners {
        for tag in [TAGGED, UNTAGGED] {
            let (file, count) = served(Manner { answer, tag });
            let read = read_whole(&file).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(read == bytes(), "{name}: {} bytes", read.len());
            assert!(file.failure().is_none(), "{name}");
            let requests = count.load(Ordering::Relaxed);
            assert!(requests >= 4 && (name == "good" || name == "slow" || requests > 4), "{name}: {requests} requests");
        }
    }
}

#[test]
fn what_a_server_withholds_is_an_error_and_never_an_end() {
    const BROKEN_FROM: usize = 1 << 20;
    let manners: [(&str, Answering, Tagging); 7] = [
        (
            "the store answered 503",
            |_, range| if range.start < BROKEN_FROM { Answer::Good } else { Answer::Status(503) },
            TAGGED,
        ),
        (
            "sent fewer bytes than hovertone asked for",
            |_, range| if range.start < BROKEN_FROM { Answer::Good } else { Answer::Cut },
            UNTAGGED,
        ),
        (
            "sent fewer bytes than hovertone asked for",
            |_, range| if range.start < BROKEN_FROM { Answer::Good } else { Answer::Cut },
            TAGGED,
        ),
        (
            "did not answer in time",
            |_, range| if range.start < BROKEN_FROM { Answer::Good } else { Answer::Silent },
            UNTAGGED,
        ),
        ("sends whole files only", |_, _| Answer::WholeFile, TAGGED),
        (
            "no usable answer",
            |_, range| if range.start < BROKEN_FROM { Answer::Good } else { Answer::OtherRange },
            TAGGED,
        ),
        ("changed while it was read", |_, _| Answer::Good, |number| Some(number)),
    ];
    for (words, answer, tag) in manners {
        let (file, _) = served(Manner { answer, tag });
        let error = read_whole(&file).expect_err(words).to_string();
        assert!(error.contains(words) && error.contains("; "), "{words}: {error}");
        assert!(file.failure().is_some_and(|failure| failure.to_string() == error), "{words}");
        // a decoder meets the same error, whether at the beginning or on the way
        let heard = Recording::open_file(Arc::new(file), &OpenOptions::default()).map_err(|error| error.to_string());
        let ended = heard.and_then(|mut sound| {
            while sound.next_block().map_err(|error| error.to_string())?.is_some() {}
            Ok(())
        });
        assert!(ended.expect_err(words).contains(words), "{words}");
    }
}

#[test]
fn a_recording_of_some_blocks_is_fetched_once_however_often_it_is_heard() {
    let (file, count) = served(Manner { answer: |_, _| Answer::Good, tag: TAGGED });
    let file: Arc<dyn FileAccess> = Arc::new(file);
    let mut recording = Recording::open_file(Arc::clone(&file), &OpenOptions::default()).unwrap();
    let mut sample_count = 0;
    for _ in 0..3 {
        recording.rewind().unwrap();
        while let Some(block) = recording.next_block().unwrap() {
            sample_count += block.len();
        }
    }
    assert_eq!(sample_count, 3 * ((SIZE - 44) / 2));
    assert_eq!(count.load(Ordering::Relaxed), 4, "a request for each block");
    let mut open = file.open().unwrap();
    let mut read = [0; 9];
    for at in [0, (1 << 20) - 4, SIZE - 9] {
        open.seek(SeekFrom::Start(at as u64)).unwrap();
        open.read_exact(&mut read).unwrap();
        assert_eq!(read, bytes()[at..at + 9]);
    }
    open.seek(SeekFrom::End(5)).unwrap();
    assert_eq!(open.read(&mut read).unwrap(), 0);
}

#[test]
fn a_server_that_is_gone_is_told() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let text = format!("http://{}/x.wav", listener.local_addr().unwrap());
    drop(listener);
    let error = Stores::new(PATIENCE).unwrap().file(&Address::parse(&text).unwrap()).unwrap_err();
    assert_eq!(error.to_string(), "the store cannot be reached");
}
