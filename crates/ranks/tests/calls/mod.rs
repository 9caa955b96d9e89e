//! Every call of a rank, with what it has to give.

use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use piola_ranks::{Exact, Message, RankError, Ranks, Threads};

/// Makes every call, on each of the ranks.
///
/// # Errors
/// A call fails.
///
/// # Panics
/// A call gives something else than it has to.
pub fn every_call(ranks: &dyn Ranks) -> Result<(), RankError> {
    let (rank, size) = (ranks.rank(), ranks.size());
    assert!(rank < size, "rank {rank} of {size}");
    around_a_ring(ranks, 300)?;
    among_all(ranks)?;
    sums(ranks)?;

    let all: Vec<Vec<f64>> = (0..size).map(own).collect();
    assert_eq!(bits(&ranks.gather_to_all(&own(rank))?), bits(&all));
    assert_eq!(ranks.gather_to_all(&[])?, vec![Vec::new(); size]);
    let gathered = ranks.gather(&own(rank))?;
    assert_eq!(bits(&gathered), bits(if rank == 0 { &all } else { &[] }));
    let shared = ranks.scatter(if rank == 0 { &all } else { &[] })?;
    assert_eq!(bits(&[shared]), bits(&[own(rank)]));
    for length in [0, 1, 100_000] {
        let said: Vec<f64> = (0..length).map(|i| f64::from(i).sqrt()).collect();
        let ours = if rank == 0 { said.clone() } else { vec![1.0; rank] };
        assert_eq!(ranks.broadcast(ours)?, said);
    }
    Ok(())
}

/// What a rank has: of uneven length, nothing on rank 0, and bits that are easily lost.
fn own(rank: usize) -> Vec<f64> {
    let payload = f64::from_bits(0x7ff0_0000_dead_beef);
    (0..rank * rank).map(|i| if i % 3 == 1 { payload } else { -((i / 2) as f64) }).collect()
}

fn bits(all: &[Vec<f64>]) -> Vec<Vec<u64>> {
    all.iter().map(|numbers| numbers.iter().map(|x| x.to_bits()).collect()).collect()
}

/// Each rank passes on what comes from the one before it, with a length that differs from rank to rank and from round
/// to round, and is 0 at times.
fn around_a_ring(ranks: &dyn Ranks, rounds: usize) -> Result<(), RankError> {
    let (rank, size) = (ranks.rank(), ranks.size());
    let (before, next) = ((rank + size - 1) % size, (rank + 1) % size);
    let length = |rank: usize, round: usize| 37 * ((rank + round) % 5);
    let number = |rank: usize, round: usize, i: usize| (rank * 1000 + round * 7 + i) as f64;
    for round in 0..rounds {
        let of = |rank| (0..length(rank, round)).map(|i| number(rank, round, i)).collect();
        let send = [Message { rank: next, numbers: of(rank) }];
        let numbers = vec![f64::NAN; length(before, round)];
        let mut receive = [Message { rank: before, numbers }];
        ranks.exchange(&send, &mut receive)?;
        assert_eq!(receive[0].numbers, of(before), "round {round}");
    }
    Ok(())
}

/// Two messages from each to each, itself included: a short one, and one that is too long to be sent ahead. Then some
/// that have no partners.
fn among_all(ranks: &dyn Ranks) -> Result<(), RankError> {
    let (rank, size) = (ranks.rank(), ranks.size());
    let number = |from: usize, to: usize, i: usize| (from * 100 + to) as f64 + i as f64 / 8.0;
    let numbers = |from, to, length| (0..length).map(|i| number(from, to, i)).collect();
    let of = |length: usize, from: usize, to: usize| match from + to {
        sum if sum % 3 == 2 => Vec::new(),
        sum => numbers(from, to, length + sum),
    };
    let both = |other| [3, 60_000].map(|length| (length, other));
    let pairs: Vec<(usize, usize)> = (0..size).flat_map(both).collect();
    let message = |rank, numbers| Message { rank, numbers };
    let send: Vec<Message> =
        pairs.iter().map(|&(length, to)| message(to, of(length, rank, to))).collect();
    let expected: Vec<Message> =
        pairs.iter().map(|&(length, from)| message(from, of(length, from, rank))).collect();
    let mut receive: Vec<Message> =
        expected.iter().map(|m| message(m.rank, vec![0.0; m.numbers.len()])).collect();
    ranks.exchange(&send, &mut receive)?;
    assert_eq!(receive, expected);

    // The last rank tells the first one something; those between take no part.
    let last = [Message { rank: 0, numbers: vec![5.0] }];
    let mut first = [Message { rank: size - 1, numbers: vec![0.0] }];
    let sends = if rank == size - 1 { &last[..] } else { &[] };
    let receives = if rank == 0 { &mut first[..] } else { &mut [] };
    ranks.exchange(sends, receives)?;
    assert!(rank > 0 || first[0].numbers == [5.0]);
    Ok(())
}

fn sums(ranks: &dyn Ranks) -> Result<(), RankError> {
    let (rank, size) = (ranks.rank() as i64, ranks.size() as i64);
    let mut numbers = [rank + 1, i64::MAX, -1, 1 << 40];
    ranks.add(&mut numbers)?;
    // Sums wrap around: 2⁶³ - 1 is -1 but for 2⁶³.
    let wrapped = if size % 2 == 0 { -size } else { i64::MAX - (size - 1) };
    assert_eq!(numbers, [size * (size + 1) / 2, wrapped, -size, size << 40]);
    ranks.add(&mut [])?;
    let mut many: Vec<i64> = (0..50_000).map(|i| i * (rank + 1)).collect();
    ranks.add(&mut many)?;
    assert!(many.iter().zip(0..).all(|(&sum, i)| sum == i * (size * (size + 1) / 2)));

    // Terms of any size and sign, shared among the ranks.
    let term =
        |i: i32| f64::from(i % 13 - 6) * 2f64.powi(37 * i % 2000 - 1000) + 1.0 / f64::from(i);
    let (mut part, mut whole) = (Exact::default(), Exact::default());
    for i in 1..2000 {
        whole.add(term(i));
        if i64::from(i) % size == rank {
            part.add(term(i));
        }
    }
    ranks.add(part.limbs_mut())?;
    assert_eq!(part.total().to_bits(), whole.total().to_bits());
    Ok(())
}

/// What `body` returns on each of some threads, by rank: `None` for those that have panicked. Waits for a minute.
///
/// # Panics
/// A rank waits for ever.
pub fn on_threads<R: Send + 'static>(
    size: usize,
    body: impl Fn(Threads) -> R + Clone + Send + 'static,
) -> Vec<Option<R>> {
    let ends: Vec<_> = Threads::group(size)
        .into_iter()
        .map(|rank| {
            let (body, (told, end)) = (body.clone(), channel());
            let thread = thread::spawn(move || {
                // Nobody listens any more if another rank waits for ever.
                let _ = told.send(body(rank));
            });
            (thread, end)
        })
        .collect();
    let finish = |(thread, end): (thread::JoinHandle<()>, std::sync::mpsc::Receiver<R>)| {
        match end.recv_timeout(Duration::from_secs(60)) {
            Err(std::sync::mpsc::RecvTimeoutError::Timeout) => panic!("a rank waits for ever"),
            got => {
                // A panic has been seen as the lack of a message.
                let _ = thread.join();
                got.ok()
            }
        }
    };
    ends.into_iter().map(finish).collect()
}
