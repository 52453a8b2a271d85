//! Admission of requests: those to the server's own address, from its own page or from a program.

use std::net::{IpAddr, SocketAddr};

use axum::http::header::{self, HeaderMap, HeaderName};

/// Port of an address that names none.
const HTTP: u16 = 80;
/// Headers in which a browser states the site of the requesting page and the mode of the request.
const FETCH_SITE: HeaderName = HeaderName::from_static("sec-fetch-site");
const FETCH_MODE: HeaderName = HeaderName::from_static("sec-fetch-mode");

/// Decision on a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Admission {
    /// The request is answered.
    Granted,
    /// The request is for another host.
    OtherHost,
    /// The request comes from another page.
    OtherPage,
}

/// Admits requests to the addresses of this server only. A host name that an attacker's name server resolves
/// to this machine (DNS rebinding) is not admitted.
#[derive(Debug, Clone)]
pub(crate) struct Guard {
    address: SocketAddr,
}

impl Guard {
    /// Creates the guard of the address that the server is bound to.
    pub(crate) fn new(address: SocketAddr) -> Self {
        Self { address }
    }

    /// Decides on a request for `path` with these headers.
    pub(crate) fn admits(&self, path: &str, headers: &HeaderMap) -> Admission {
        // A header that is not text is never an address of this server, and two `Host` headers are ambiguous.
        let text = |name: &HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or_default());
        let is_one = headers.get_all(header::HOST).iter().count() == 1;
        if !is_one || !text(&header::HOST).is_some_and(|host| self.is_own_host(host)) {
            return Admission::OtherHost;
        }
        let mut origins = headers.get_all(header::ORIGIN).iter();
        if !origins.all(|origin| origin.to_str().is_ok_and(|origin| self.is_own_origin(origin))) {
            return Admission::OtherPage;
        }
        // Requests for images or scripts from another page carry no `Origin`. A link to the page itself is
        // admitted.
        let is_own_page = text(&FETCH_SITE).is_none_or(|site| matches!(site, "same-origin" | "none"));
        let is_link = path == "/" && text(&FETCH_MODE) == Some("navigate");
        if is_own_page || is_link { Admission::Granted } else { Admission::OtherPage }
    }

    /// Returns true if `Host` names this server: its address, `localhost` if it listens on loopback, or any
    /// literal address if it listens on all addresses. The port must match, and may be omitted if it is the
    /// HTTP port.
    fn is_own_host(&self, host: &str) -> bool {
        let (name, port) = match host.rsplit_once(':') {
            Some((name, port)) if !host.ends_with(']') => (name, port.parse().ok()),
            _ => (host, Some(HTTP)),
        };
        if port != Some(self.address.port()) {
            return false;
        }
        let ip = self.address.ip();
        let name = name.to_ascii_lowercase();
        if name == "localhost" {
            return ip.is_loopback() || ip.is_unspecified();
        }
        let literal = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(&name);
        literal.parse::<IpAddr>().is_ok_and(|asked| asked == ip || ip.is_unspecified())
    }

    /// Returns true if `Origin` is a page of this server.
    fn is_own_origin(&self, origin: &str) -> bool {
        origin.strip_prefix("http://").is_some_and(|host| self.is_own_host(host))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(address: &str, host: &str, expected: bool) {
        let guard = Guard::new(address.parse().unwrap());
        assert_eq!(guard.is_own_host(host), expected, "{host} at {address}");
        assert_eq!(guard.is_own_origin(&format!("http://{host}")), expected);
        assert!(!guard.is_own_origin(&format!("https://{host}")) && !guard.is_own_origin("null"));
    }

    fn admission(path: &str, headers: &[(HeaderName, &str)]) -> Admission {
        let mut map = HeaderMap::new();
        for (name, value) in headers {
            map.append(name, value.parse().unwrap());
        }
        Guard::new("127.0.0.1:8080".parse().unwrap()).admits(path, &map)
    }

    #[test]
    fn the_bound_address_and_localhost_are_own() {
        check("127.0.0.1:8080", "127.0.0.1:8080", true);
        check("127.0.0.1:8080", "LocalHost:8080", true);
        check("[::1]:8080", "[::1]:8080", true);
        check("[::1]:8080", "localhost:8080", true);
        check("192.0.2.7:80", "192.0.2.7:80", true);
        check("192.0.2.7:80", "192.0.2.7", true);
        check("[::1]:80", "[::1]", true);
        check("0.0.0.0:8080", "192.0.2.7:8080", true);
        check("[::]:8080", "[2001:db8::1]:8080", true);
    }

    #[test]
    fn other_names_ports_and_addresses_are_not() {
        for host in [
            "evil.example:8080",
            "127.0.0.1:8081",
            "127.0.0.1",
            "",
            ":8080",
            ":",
            "[]:8080",
            "127.0.0.1.evil.example:8080",
            "localhost.:8080",
            "localhost.evil.example:8080",
            "127.0.0.1.:8080",
            "127.1:8080",
            "2130706433:8080",
            "0x7f000001:8080",
            "0.0.0.0:8080",
            "[::1]:8080",
            "[::ffff:127.0.0.1]:8080",
            "user@127.0.0.1:8080",
            "127.0.0.1:8080:8080",
            "127.0.0.1:8080 evil.example",
            "127.0.0.1:73616",
        ] {
            check("127.0.0.1:8080", host, false);
        }
        check("192.0.2.7:80", "localhost:80", false);
        check("192.0.2.7:80", "127.0.0.1:80", false);
        check("0.0.0.0:8080", "evil.example:8080", false);
        check("[::]:8080", "evil.example:8080", false);
    }

    #[test]
    fn a_request_has_one_host_and_no_origin_but_the_own() {
        let own = (header::HOST, "127.0.0.1:8080");
        let origin = |origin| (header::ORIGIN, origin);
        assert_eq!(admission("/", std::slice::from_ref(&own)), Admission::Granted);
        assert_eq!(admission("/", &[own.clone(), origin("http://127.0.0.1:8080")]), Admission::Granted);
        assert_eq!(admission("/", &[]), Admission::OtherHost);
        assert_eq!(admission("/", &[own.clone(), (header::HOST, "evil.example")]), Admission::OtherHost);
        for other in
            ["null", "", "http://127.0.0.1:8081", "https://127.0.0.1:8080", "http://evil.example:8080"]
        {
            assert_eq!(admission("/", &[own.clone(), origin(other)]), Admission::OtherPage, "{other}");
        }
        let both = [own, origin("http://127.0.0.1:8080"), origin("null")];
        assert_eq!(admission("/", &both), Admission::OtherPage);
    }

    #[test]
    fn embedding_by_another_page_is_refused_and_a_link_is_not() {
        let check = |path, site, mode, expected| {
            let headers = [(header::HOST, "127.0.0.1:8080"), (FETCH_SITE, site), (FETCH_MODE, mode)];
            assert_eq!(admission(path, &headers), expected, "{path} {site} {mode}");
        };
        check("/api/progress.json", "same-origin", "cors", Admission::Granted);
        check("/api/progress.json", "none", "navigate", Admission::Granted);
        check("/", "cross-site", "navigate", Admission::Granted);
        for site in ["cross-site", "same-site", "new-word"] {
            check("/api/frames/0.gray", site, "no-cors", Admission::OtherPage);
            check("/api/frames/0.gray", site, "navigate", Admission::OtherPage);
            check("/", site, "no-cors", Admission::OtherPage);
        }
    }
}
