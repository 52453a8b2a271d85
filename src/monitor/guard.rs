//! Who may ask: requests to the server's own address, from its own page or from a program.

use std::net::{IpAddr, SocketAddr};

/// The addresses by which the server answers. A name that an attacker's own name server points here (DNS rebinding) is none.
#[derive(Debug, Clone)]
pub(super) struct Guard {
    address: SocketAddr,
}

impl Guard {
    /// Of the address that the server is bound to.
    pub(super) fn new(address: SocketAddr) -> Self {
        Self { address }
    }

    /// Whether `Host` is this server: its address, the loopback's names where it listens there, and any literal address where
    /// it listens on all of them; the port must be there and right.
    pub(super) fn is_own_host(&self, host: &str) -> bool {
        let Some((name, port)) = host.rsplit_once(':') else { return false };
        if port != self.address.port().to_string() {
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

    /// Whether `Origin` is a page of this server.
    pub(super) fn is_own_origin(&self, origin: &str) -> bool {
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

    #[test]
    fn the_bound_address_and_localhost_are_own() {
        check("127.0.0.1:8080", "127.0.0.1:8080", true);
        check("127.0.0.1:8080", "LocalHost:8080", true);
        check("[::1]:8080", "[::1]:8080", true);
        check("192.0.2.7:80", "192.0.2.7:80", true);
        check("0.0.0.0:8080", "192.0.2.7:8080", true);
    }

    #[test]
    fn other_names_ports_and_addresses_are_not() {
        for host in
            ["evil.example:8080", "127.0.0.1:8081", "127.0.0.1", "", ":8080", "127.0.0.1.evil.example:8080"]
        {
            check("127.0.0.1:8080", host, false);
        }
        check("192.0.2.7:80", "localhost:80", false);
        check("192.0.2.7:80", "127.0.0.1:80", false);
        check("0.0.0.0:8080", "evil.example:8080", false);
    }
}
